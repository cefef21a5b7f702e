#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/view_graph.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::IsSupersetOf;

const std::vector<ViewPair> kTrue = {{3, 5}, {4, 5}};
const std::vector<ViewPair> kLookAlike = {{0, 8}, {1, 9}, {2, 7}};

// Matches that the relative pose explains: their features are added to the
// views, and nothing else sees them.
void AddMatches(RelativePose* pose, Scene* scene) {
  Random random(7);
  const RigidTransform cam2_from_cam1 = pose->Cam2FromCam1();
  const auto add = [&](ViewId view, const Vec3& point_in_cam) {
    const Vec2 noise_px(random.Gaussian(0.5), random.Gaussian(0.5));
    auto& points_px = scene->features.at(view).points_px;
    points_px.emplace_back(scene->FindIntrinsic(view)->Project(point_in_cam) +
                           noise_px);
    return static_cast<FeatureIndex>(points_px.size() - 1);
  };
  while (pose->point_inliers.size() < 40) {
    const Vec3 point_in_cam1(random.Uniform(-2, 2), random.Uniform(-1, 1),
                             random.Uniform(3, 6));
    const Vec3 point_in_cam2 = cam2_from_cam1 * point_in_cam1;
    if (point_in_cam2.z() < 1) continue;
    const FeatureIndex in_first = add(pose->views.first, point_in_cam1);
    pose->point_inliers.push_back(
        {in_first, add(pose->views.second, point_in_cam2)});
  }
}

// Views 0 to 4 and 5 to 9, which two right relative poses join, and three false
// ones that are of one mind: they turn the ones against the others by half a
// turn, and no third view sees what they see.
SyntheticScene TwoPlacesThatLookAlike(double true_log10_nfa,
                                      double look_alike_log10_nfa) {
  SyntheticOptions options;
  options.num_views = 10;
  options.pairs = "window:3";
  options.noise_px = 0.5;
  options.seed = 4;
  SyntheticScene made = *Simulate(options);
  auto& poses = made.scene.relative_poses;
  for (auto pose = poses.begin(); pose != poses.end();) {
    const ViewPair& views = pose->first;
    const bool is_across =
        views.first < ViewId(5) && !(views.second < ViewId(5));
    if (!is_across) {
      pose->second.log10_nfa = -100;
    } else if (std::find(kTrue.begin(), kTrue.end(), views) != kTrue.end()) {
      pose->second.log10_nfa = true_log10_nfa;
    } else {
      pose = poses.erase(pose);
      continue;
    }
    ++pose;
  }
  const Mat3 half_turn = RotationFromAngleAxis(kPi * Vec3::UnitY());
  for (const ViewPair& views : kLookAlike) {
    const Pose& first = made.true_poses.at(views.first);
    const Pose& second = made.true_poses.at(views.second);
    RelativePose& pose = poses[views];
    pose.views = views;
    pose.rotation = second.rotation * half_turn * first.rotation.transpose();
    pose.direction = Vec3(1, 0.2, 0.3).normalized();
    pose.log10_nfa = look_alike_log10_nfa;
    pose.covariance = 1e-6 * Eigen::Matrix<double, 5, 5>::Identity();
    AddMatches(&pose, &made.scene);
  }
  return made;
}

double LargestError(const SyntheticScene& made) {
  return EvaluatePoses(made.scene, made.true_poses).position.max;
}

TEST(SettleContests, LinksThatNoThirdViewBearsOutGiveWay) {
  SyntheticScene made = TwoPlacesThatLookAlike(-40, -20);
  SolveOptions options;
  options.adjust = false;
  const auto solved = SolveScene(&made.scene, options, RunContext(), nullptr);
  ASSERT_TRUE(solved) << solved.error().ToString();
  EXPECT_EQ(solved->poses.num_placed, 10);
  EXPECT_LT(LargestError(made), 0.1);
  EXPECT_THAT(PairsOf(solved->poses.outlier_edges), IsSupersetOf(kLookAlike));
  EXPECT_THAT(solved->poses.contests, IsEmpty());
}

TEST(SettleContests, WhatNoThirdViewBearsOutContestsNothing) {
  SyntheticScene made = TwoPlacesThatLookAlike(-50, -70);
  for (const ViewPair& views : {kLookAlike[1], kLookAlike[2]}) {
    made.scene.relative_poses.erase(views);
  }
  SolveOptions options;
  options.adjust = false;
  const auto solved = SolveScene(&made.scene, options, RunContext(), nullptr);
  ASSERT_TRUE(solved) << solved.error().ToString();
  EXPECT_LT(LargestError(made), 0.1);
  EXPECT_THAT(PairsOf(solved->poses.outlier_edges), Contains(kLookAlike[0]));
  EXPECT_THAT(solved->poses.contests, IsEmpty());
}

}  // namespace
}  // namespace lowlap
