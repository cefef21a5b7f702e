#include "lowlap/two_view/internal/informed_pose.h"

#include <gtest/gtest.h>

#include <numeric>
#include <vector>

#include "lowlap/two_view/internal/planes/planar_motion.h"
#include "lowlap/two_view/internal/search/same_pose.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::MakeTwoViewScene;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

RelativePose PoseOf(const TwoViewScene& scene, const RigidTransform& motion) {
  RelativePose pose;
  pose.views = {3, 8};
  pose.rotation = motion.rotation;
  pose.direction = motion.translation;
  pose.point_inliers = scene.matches;
  pose.point_threshold_px = 1;
  pose.log10_nfa = -20;
  return pose;
}

Mat3 Turned(const Mat3& rotation, double angle_deg) {
  return RotationFromAngleAxis(Vec3(0, RadFromDeg(angle_deg), 0)) * rotation;
}

// 30 matches of one plane, under the other of its two motions.
struct PlaneUnderItsTwin {
  TwoViewScene scene;
  RelativePose pose;

  explicit PlaneUnderItsTwin(std::uint64_t seed) {
    TwoViewSceneOptions options;
    options.num_right = 30;
    options.planar = true;
    options.noise_px = 0.3;
    scene = MakeTwoViewScene(options, seed);
    const PointPairs pairs = scene.Pairs();
    std::vector<int> all(pairs.size());
    std::iota(all.begin(), all.end(), 0);
    Random random(seed);
    const auto plane =
        DominantPlane(scene.cam2_from_cam1, pairs, all, 3, random);
    pose = PoseOf(scene, *OtherPlanarMotion(scene.cam2_from_cam1, plane->normal,
                                            pairs.x1[plane->inliers.front()]));
  }
};

TEST(InformPose, ThePriorDecidesBetweenTheMotionsOfAPlane) {
  for (int seed = 0; seed < 5; ++seed) {
    const PlaneUnderItsTwin twin(seed);
    const RotationPrior prior{Turned(twin.scene.cam2_from_cam1.rotation, 0.5),
                              RadFromDeg(0.7)};
    const InformedPose informed =
        InformPose(twin.scene.Input(), twin.pose, prior, seed);
    EXPECT_GT(informed.gained_digits, 1) << seed;
    EXPECT_LT(testing::RotationErrorDeg(informed.pose.rotation,
                                        twin.scene.cam2_from_cam1.rotation),
              1.2)
        << seed;
    EXPECT_LT(testing::DirectionErrorDeg(informed.pose.direction,
                                         twin.scene.cam2_from_cam1.translation),
              5)
        << seed;
    EXPECT_EQ(informed.pose.log10_nfa, -20);
    EXPECT_GE(informed.pose.point_inliers.size(), 25u);
    ASSERT_TRUE(informed.pose.covariance);
  }
}

TEST(InformPose, AnotherMotionOfWeakMatchesIsAsWeak) {
  PlaneUnderItsTwin twin(0);
  twin.pose.weakness = PoseWeakness::kRepeats;
  const RotationPrior prior{twin.scene.cam2_from_cam1.rotation,
                            RadFromDeg(0.7)};
  const InformedPose informed =
      InformPose(twin.scene.Input(), twin.pose, prior, 0);
  ASSERT_GT(informed.gained_digits, 1);
  EXPECT_EQ(informed.pose.weakness, PoseWeakness::kRepeats);
}

// What the plane leaves open the covariance no longer does: the prior is in it.
TEST(InformPose, TheCovarianceHoldsThePrior) {
  double before = 0;
  for (const double stddev_deg : {0.02, 0.2, 2.0}) {
    double variance = 0;
    for (int seed = 0; seed < 20; ++seed) {
      const PlaneUnderItsTwin twin(seed);
      const RotationPrior prior{twin.scene.cam2_from_cam1.rotation,
                                RadFromDeg(stddev_deg)};
      const InformedPose informed =
          InformPose(twin.scene.Input(), twin.pose, prior, seed);
      variance += informed.pose.covariance->topLeftCorner<3, 3>().trace();
    }
    EXPECT_GT(variance, before);
    before = variance;
  }
}

TEST(InformPose, MatchesThatTellTheMotionAreNotMovedByAWrongPrior) {
  TwoViewSceneOptions options;
  options.num_right = 80;
  options.noise_px = 0.3;
  for (int seed = 0; seed < 5; ++seed) {
    const TwoViewScene scene = MakeTwoViewScene(options, seed);
    const RotationPrior prior{Turned(scene.cam2_from_cam1.rotation, 8),
                              RadFromDeg(0.5)};
    const InformedPose informed = InformPose(
        scene.Input(), PoseOf(scene, scene.cam2_from_cam1), prior, seed);
    EXPECT_LT(testing::RotationErrorDeg(informed.pose.rotation,
                                        scene.cam2_from_cam1.rotation),
              0.2)
        << seed;
  }
}

TEST(InformPose, TooFewMatchesLeaveThePoseAsItIs) {
  PlaneUnderItsTwin twin(2);
  TwoViewInput input = twin.scene.Input();
  input.point_matches.resize(5);
  const InformedPose informed = InformPose(
      input, twin.pose, {twin.scene.cam2_from_cam1.rotation, 0.01}, 0);
  EXPECT_EQ(informed.pose, twin.pose);
  EXPECT_EQ(informed.gained_digits, 0);
}

}  // namespace
}  // namespace lowlap
