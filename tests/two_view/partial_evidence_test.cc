#include "lowlap/two_view/internal/evidence/partial_evidence.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "tests/support/random_vectors.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::kFocalPx;
using testing::TwoViewScene;

RelativePose TruePose(const TwoViewScene& scene) {
  RelativePose pose;
  pose.rotation = scene.cam2_from_cam1.rotation;
  pose.direction = scene.cam2_from_cam1.translation.normalized();
  pose.point_threshold_px = 1;
  return pose;
}

double Scattered(const TwoViewScene& scene) {
  Random random(4);
  const TwoViewInput input = scene.Input();
  return ScatteredEvidence(input, ShuffleMatches(input, random),
                           TruePose(scene), {});
}

double OfAll(const TwoViewScene& scene) {
  Random random(4);
  const TwoViewInput input = scene.Input();
  const ShuffledMatches matches = ShuffleMatches(input, random);
  std::vector<int> all(matches.pairs.size());
  std::iota(all.begin(), all.end(), 0);
  return EvidenceOfSome(input, matches, all, TruePose(scene), {});
}

// Right matches, each with eight others within 5 px in both images.
TwoViewScene Clusters(int count, int num_wrong) {
  testing::TwoViewSceneOptions options;
  options.num_right = count;
  options.num_wrong = num_wrong;
  TwoViewScene scene = testing::MakeTwoViewScene(options, 3);
  Random random(5);
  for (int n = 0; n < count; ++n) {
    for (int more = 0; more < 8; ++more) {
      const Vec2 step =
          testing::UniformVec2(random, {-5, -5}, {5, 5}) / kFocalPx;
      const Vec3 by(step.x(), step.y(), 0);
      const Vec3 x1 = scene.features1.points[n] + by;
      Vec3 x2 = scene.features2.points[n] + by;
      // Onto the epipolar line.
      const Mat3 essential = CrossMatrix(scene.cam2_from_cam1.translation) *
                             scene.cam2_from_cam1.rotation;
      const Vec3 line = essential * x1;
      x2.head<2>() -=
          line.dot(x2) / line.head<2>().squaredNorm() * line.head<2>();
      const auto index = static_cast<FeatureIndex>(scene.matches.size());
      scene.features1.points.push_back(x1);
      scene.features2.points.push_back(x2);
      scene.matches.push_back({index, index});
    }
  }
  return scene;
}

TEST(ScatteredEvidence, IsThatOfAllWhereMatchesLieApart) {
  testing::TwoViewSceneOptions options;
  options.num_right = 30;
  options.num_wrong = 30;
  options.noise_px = 0.3;
  const TwoViewScene scene = testing::MakeTwoViewScene(options, 2);
  EXPECT_LT(Scattered(scene), -15);
  EXPECT_LT(OfAll(scene), Scattered(scene) + 1);
}

TEST(ScatteredEvidence, CountsWhatLiesSideBySideOnce) {
  const TwoViewScene few = Clusters(7, 30);
  EXPECT_LT(OfAll(few), -40);
  EXPECT_GT(Scattered(few), 0.2 * OfAll(few));
  // Five places tell no motion from another.
  const TwoViewScene five = Clusters(5, 0);
  EXPECT_LT(OfAll(five), -40);
  EXPECT_TRUE(std::isinf(Scattered(five)));
}

}  // namespace
}  // namespace lowlap
