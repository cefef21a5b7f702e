#include "lowlap/two_view/internal/direction_check.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <vector>

#include "lowlap/geometry/internal/rotation.h"
#include "tests/support/random_vectors.h"
#include "tests/two_view/line_scene.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using testing::LineScene;
using testing::MakeLineScene;
using testing::MakeTwoViewScene;
using ::testing::Not;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

constexpr double kSameRad = 0.05;

TwoViewSceneOptions Points(int num_right) {
  TwoViewSceneOptions options;
  options.num_right = num_right;
  options.noise_px = 0.5;
  return options;
}

DirectionCheck Check(const TwoViewScene& scene, const Vec3& direction,
                     std::uint64_t seed = 0) {
  RelativePose pose;
  pose.views = {3, 8};
  pose.rotation = scene.cam2_from_cam1.rotation;
  pose.direction = direction.normalized();
  pose.point_inliers = scene.matches;
  return CheckDirection(scene.Input(), pose, kSameRad, seed);
}

TEST(DirectionCheck, BearsOutTheRightDirection) {
  for (const int count : {8, 12, 40, 1000}) {
    for (std::uint64_t seed = 0; seed < 20; ++seed) {
      const TwoViewScene scene = MakeTwoViewScene(Points(count), seed);
      EXPECT_EQ(Check(scene, scene.cam2_from_cam1.translation, seed).verdict,
                DirectionVerdict::kBorneOut)
          << count << " points, seed " << seed;
    }
  }
}

TEST(DirectionCheck, ReplacesAWrongDirectionUnderTheRightRotation) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const TwoViewScene scene = MakeTwoViewScene(Points(30), seed);
    Random random(seed);
    Vec3 wrong;
    do {
      wrong = testing::GaussianVec3(random).normalized();
    } while (AngleBetween(wrong, scene.cam2_from_cam1.translation) < 0.3);
    const DirectionCheck check = Check(scene, wrong, seed);
    ASSERT_EQ(check.verdict, DirectionVerdict::kReplaced) << seed;
    EXPECT_LT(AngleBetween(check.replacement->direction,
                           scene.cam2_from_cam1.translation),
              RadFromDeg(2));
    EXPECT_GT(check.error_rad, kSameRad);
  }
}

// Triplets get their coplanar and trifocal lines from them.
TEST(DirectionCheck, AReplacedDirectionKeepsTheLineMatchesThatFitIt) {
  LineScene scene = MakeLineScene({}, 5);
  const TwoViewScene points = MakeTwoViewScene(Points(30), 5);
  scene.views.features1.points = points.features1.points;
  scene.views.features2.points = points.features2.points;
  scene.views.matches = points.matches;
  const std::vector<FeatureMatch> right = scene.line_matches;
  // A part of the second line that the first view does not see.
  auto& segments2 = scene.views.features2.segments;
  const NormalizedSegment& whole = segments2[right[0].second];
  const Vec3 beyond = 2 * (whole.end - whole.start);
  const FeatureMatch wrong{right[0].first,
                           static_cast<FeatureIndex>(segments2.size())};
  segments2.push_back(
      testing::MakeSegment(whole.start + beyond, whole.end + beyond));
  scene.line_matches.push_back(wrong);
  RelativePose pose;
  pose.views = {3, 8};
  pose.rotation = scene.cam2_from_cam1.rotation;
  pose.direction = -scene.cam2_from_cam1.translation;
  pose.point_inliers = points.matches;
  pose.line_inliers = scene.line_matches;
  const DirectionCheck check = CheckDirection(scene.Input(), pose, kSameRad, 5);
  ASSERT_EQ(check.verdict, DirectionVerdict::kReplaced);
  const std::vector<FeatureMatch>& kept = check.replacement->line_inliers;
  // All but those close to epipolar planes.
  EXPECT_GE(kept.size(), 0.8 * right.size());
  EXPECT_THAT(kept, Not(Contains(wrong)));
}

TEST(DirectionCheck, TheCovarianceOfAWrongDirectionIsNotThatOfTheRightOne) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    // Too few to refine the other direction, and to say how well it is known.
    const TwoViewScene scene = MakeTwoViewScene(Points(5), seed);
    RelativePose pose;
    pose.views = {3, 8};
    pose.rotation = scene.cam2_from_cam1.rotation;
    pose.direction = -scene.cam2_from_cam1.translation;
    pose.point_inliers = scene.matches;
    pose.covariance = 1e-8 * Eigen::Matrix<double, 5, 5>::Identity();
    const DirectionCheck check =
        CheckDirection(scene.Input(), pose, kSameRad, seed);
    ASSERT_EQ(check.verdict, DirectionVerdict::kReplaced) << seed;
    EXPECT_FALSE(check.replacement->covariance) << seed;
  }
}

TEST(DirectionCheck, AnotherDirectionOfWeakMatchesIsAsWeak) {
  const TwoViewScene scene = MakeTwoViewScene(Points(30), 5);
  RelativePose pose;
  pose.views = {3, 8};
  pose.rotation = scene.cam2_from_cam1.rotation;
  pose.direction = -scene.cam2_from_cam1.translation;
  pose.point_inliers = scene.matches;
  pose.weakness = PoseWeakness::kSurroundings;
  const DirectionCheck check = CheckDirection(scene.Input(), pose, kSameRad, 5);
  ASSERT_EQ(check.verdict, DirectionVerdict::kReplaced);
  EXPECT_EQ(check.replacement->weakness, PoseWeakness::kSurroundings);
}

TEST(DirectionCheck, TellsTheSignByWhatIsInFrontOfTheCameras) {
  const TwoViewScene scene = MakeTwoViewScene(Points(30), 1);
  EXPECT_EQ(Check(scene, -scene.cam2_from_cam1.translation).verdict,
            DirectionVerdict::kReplaced);
}

TEST(DirectionCheck, AFewWrongMatchesDoNotRefute) {
  TwoViewSceneOptions options = Points(30);
  options.num_wrong = 10;
  const TwoViewScene scene = MakeTwoViewScene(options, 2);
  EXPECT_EQ(Check(scene, scene.cam2_from_cam1.translation).verdict,
            DirectionVerdict::kBorneOut);
}

TEST(DirectionCheck, WrongMatchesAloneBearNothingOut) {
  TwoViewSceneOptions options = Points(0);
  options.num_wrong = 40;
  std::map<DirectionVerdict, int> count;
  for (std::uint64_t seed = 0; seed < 100; ++seed) {
    const TwoViewScene scene = MakeTwoViewScene(options, seed);
    ++count[Check(scene, Vec3(-1, 0.2, 0.1), seed).verdict];
  }
  EXPECT_LE(count[DirectionVerdict::kBorneOut], 2);
  EXPECT_LE(count[DirectionVerdict::kReplaced], 2);
}

TEST(DirectionCheck, TwoMatchesTellNothing) {
  const TwoViewScene scene = MakeTwoViewScene(Points(2), 3);
  EXPECT_EQ(Check(scene, Vec3::UnitY()).verdict, DirectionVerdict::kUntold);
  EXPECT_EQ(Check(MakeTwoViewScene(Points(0), 3), Vec3::UnitY()).verdict,
            DirectionVerdict::kUntold);
}

TEST(DirectionCheck, NorDoesARotation) {
  TwoViewSceneOptions options = Points(40);
  options.baseline = 1e-6;
  const TwoViewScene scene = MakeTwoViewScene(options, 4);
  EXPECT_EQ(Check(scene, Vec3::UnitX()).verdict, DirectionVerdict::kUntold);
}

}  // namespace
}  // namespace lowlap
