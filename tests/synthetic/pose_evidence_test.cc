#include "lowlap/synthetic/internal/pose_evidence.h"

#include <gtest/gtest.h>

#include "lowlap/synthetic/synthetic_scene.h"
#include "synthetic/must_simulate.h"

namespace lowlap {
namespace {

using testing::MustSimulate;

TEST(PoseEvidence, RightMatchesOutdoChanceAndMoreOfThemMore) {
  SyntheticOptions options;
  options.noise_px = 1;
  options.points_per_wall = 60;
  const SyntheticScene synthetic = MustSimulate(options);
  for (const auto& [views, pose] : synthetic.scene.relative_poses) {
    ASSERT_GT(pose.point_inliers.size(), 20u);
    EXPECT_LT(pose.log10_nfa, -3);
    RelativePose half = pose;
    half.point_inliers.resize(pose.point_inliers.size() / 2);
    EXPECT_LT(pose.log10_nfa, PointEvidence(synthetic.scene, half));
  }
}

TEST(PoseEvidence, IsOfAbsoluteScaleInPixels) {
  SyntheticOptions options;
  options.noise_px = 0.5;
  const SyntheticScene sharp = MustSimulate(options);
  options.noise_px = 4;
  const SyntheticScene blurred = MustSimulate(options);
  for (const auto& [views, pose] : sharp.scene.relative_poses) {
    EXPECT_LT(pose.log10_nfa, blurred.scene.relative_poses.at(views).log10_nfa);
  }
}

TEST(PoseEvidence, AnotherMotionThanThatOfTheMatchesHasNone) {
  SyntheticOptions options;
  options.noise_px = 0.5;
  const SyntheticScene synthetic = MustSimulate(options);
  for (const auto& [views, pose] : synthetic.scene.relative_poses) {
    RelativePose wrong = pose;
    wrong.rotation = pose.rotation.transpose() * pose.rotation.transpose();
    wrong.direction = Vec3(0.3, -0.8, 0.5).normalized();
    EXPECT_GT(PointEvidence(synthetic.scene, wrong), -3);
  }
}

TEST(PoseEvidence, WrongPosesClaimWhatTheRightOnesDo) {
  SyntheticOptions options;
  options.noise_px = 0.5;
  const SyntheticScene right = MustSimulate(options);
  options.wrong_direction_share = 0.5;
  options.wrong_pose_share = 0.3;
  const SyntheticScene wrong = MustSimulate(options);
  int num_changed = 0;
  for (const auto& [views, pose] : right.scene.relative_poses) {
    const RelativePose& other = wrong.scene.relative_poses.at(views);
    EXPECT_EQ(pose.log10_nfa, other.log10_nfa);
    num_changed += pose.direction != other.direction;
  }
  EXPECT_GT(num_changed, 0);
}

TEST(PoseEvidence, FivePointsOrNoneSayNothing) {
  SyntheticOptions options;
  options.points_per_wall = 0;
  for (const auto& entry : MustSimulate(options).scene.relative_poses) {
    EXPECT_EQ(entry.second.log10_nfa, 0);
  }
  options = {};
  const SyntheticScene exact = MustSimulate(options);
  RelativePose few = exact.scene.relative_poses.begin()->second;
  ASSERT_GE(few.point_inliers.size(), 8u);
  few.point_inliers.resize(8);
  EXPECT_LT(PointEvidence(exact.scene, few), 0);
  few.point_inliers.resize(5);
  EXPECT_EQ(PointEvidence(exact.scene, few), 0);
}

}  // namespace
}  // namespace lowlap
