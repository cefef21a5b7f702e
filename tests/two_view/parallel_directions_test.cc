#include "lowlap/two_view/internal/directions/parallel_directions.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "two_view/line_scene.h"

namespace lowlap {
namespace {

using testing::LineScene;
using testing::LineSceneOptions;
using testing::MakeLineScene;

std::vector<DirectionPair> PairsOf(const LineScene& scene) {
  const auto& views = scene.views;
  return PairDirections(views.features1, views.features2,
                        FindVanishingDirections(views.features1, {}),
                        FindVanishingDirections(views.features2, {}),
                        scene.line_matches);
}

TEST(PairDirections, ConnectsWhatTheMatchesConnect) {
  const auto scene = MakeLineScene({}, 1);
  const auto pairs = PairsOf(scene);
  // Each family as its matched lines and as all of its lines.
  int num_whole = 0;
  for (const DirectionPair& pair : pairs) {
    if (pair.num_matches != 12) continue;
    ++num_whole;
    EXPECT_LT(DirectionResidual(pair, scene.cam2_from_cam1.rotation).norm(),
              1e-3);
  }
  EXPECT_EQ(num_whole, 6);
}

TEST(PairDirections, NeedsTwoVotes) {
  auto scene = MakeLineScene({}, 1);
  scene.line_matches.resize(1);
  EXPECT_TRUE(PairsOf(scene).empty());
}

TEST(DirectionResidual, HasTheDerivativeOfFiniteDifferences) {
  // With round covariances the weights do not turn with the rotation.
  DirectionPair pair;
  pair.covariance1 = pair.covariance2 = 1e-4 * Mat3::Identity();
  for (const double sign : {1.0, -1.0}) {
    pair.direction1 = Vec3(0.3, -0.2, 1).normalized();
    pair.direction2 = sign * Vec3(0.25, -0.1, 1).normalized();
    const Mat3 rotation = RotationFromAngleAxis(Vec3(0.02, -0.01, 0.3));
    Eigen::Matrix<double, 2, 3> jacobian;
    DirectionResidual(pair, rotation, &jacobian);
    for (int k = 0; k < 3; ++k) {
      const double h = 1e-6;
      const auto at = [&](double step) {
        return DirectionResidual(
            pair, RotationFromAngleAxis(step * Vec3::Unit(k)) * rotation);
      };
      const Vec2 slope = (at(h) - at(-h)) / (2 * h);
      EXPECT_LT((jacobian.col(k) - slope).norm(), 1e-4);
    }
  }
}

TEST(RotationsFromDirections, ContainTheTruth) {
  for (int seed = 0; seed < 10; ++seed) {
    LineSceneOptions options;
    options.noise_px = 0.3;
    const auto scene = MakeLineScene(options, 50 + seed);
    double nearest = 180;
    for (const Mat3& rotation : RotationsFromDirections(PairsOf(scene))) {
      nearest = std::min(nearest, testing::RotationErrorDeg(
                                      rotation, scene.cam2_from_cam1.rotation));
    }
    EXPECT_LT(nearest, 0.5) << "seed " << seed;
  }
}

TEST(RotationsFromDirections, NeedTwoDirections) {
  const auto scene = MakeLineScene({}, 3);
  auto pairs = PairsOf(scene);
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(),
                             [&](const DirectionPair& p) {
                               return std::abs(p.direction1.dot(
                                          scene.directions[0])) < 0.99;
                             }),
              pairs.end());
  ASSERT_FALSE(pairs.empty());
  EXPECT_TRUE(RotationsFromDirections(pairs).empty());
}

TEST(DirectionPenalty, IsCappedByTheMatches) {
  DirectionPair pair;
  pair.covariance1 = pair.covariance2 = 1e-6 * Mat3::Identity();
  pair.num_matches = 4;
  EXPECT_NEAR(DirectionPenalty({pair}, Mat3::Identity()), 0, 1e-12);
  const Mat3 quarter = RotationFromAngleAxis(Vec3(1, 0, 0));
  EXPECT_NEAR(DirectionPenalty({pair}, quarter), 4, 1e-12);
  pair.num_matches = 100;
  EXPECT_NEAR(DirectionPenalty({pair}, quarter), 10, 1e-12);
}

}  // namespace
}  // namespace lowlap
