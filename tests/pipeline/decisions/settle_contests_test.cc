#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scale/scale_estimator.h"
#include "lowlap/scene/view_graph.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
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
    const Vec3 point_in_cam1(random.Uniform(-9, 9), random.Uniform(-1, 1),
                             random.Uniform(1, 9));
    const Vec3 point_in_cam2 = cam2_from_cam1 * point_in_cam1;
    if (point_in_cam2.z() < 1) continue;
    const FeatureIndex in_first = add(pose->views.first, point_in_cam1);
    pose->point_inliers.push_back(
        {in_first, add(pose->views.second, point_in_cam2)});
  }
}

// How the false relative poses see views 5 to 9.
struct LookAlike {
  Mat3 rotation = Mat3::Identity();  // of the views about the origin
  Vec3 shift_in_world = Vec3::Zero();
};

const LookAlike kHalfTurned = {RotationFromAngleAxis(kPi * Vec3::UnitY()),
                               Vec3(1, 0.2, 0.3)};
// As if of a row of equal windows another one were seen.
const LookAlike kOneWindowOn = {Mat3::Identity(), Vec3(1.5, 0.5, 1)};

// Views 0 to 4 and 5 to 9, which two right relative poses join, and three false
// ones that are of one mind, and whose matches no third view sees.
SyntheticScene TwoPlacesThatLookAlike(const LookAlike& look_alike,
                                      double true_log10_nfa,
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
  for (const ViewPair& views : kLookAlike) {
    const Pose& first = made.true_poses.at(views.first);
    const Pose& second = made.true_poses.at(views.second);
    RelativePose& pose = poses[views];
    pose.views = views;
    const Mat3 cam2_from_world =
        second.rotation * look_alike.rotation.transpose();
    pose.rotation = cam2_from_world * first.rotation.transpose();
    pose.direction =
        (cam2_from_world * (first.center - look_alike.rotation * second.center -
                            look_alike.shift_in_world))
            .normalized();
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
  for (const LookAlike& look_alike : {kHalfTurned, kOneWindowOn}) {
    SyntheticScene made = TwoPlacesThatLookAlike(look_alike, -40, -30);
    SolveOptions options;
    options.adjust = false;
    const auto solved = SolveScene(&made.scene, options, RunContext(), nullptr);
    ASSERT_TRUE(solved) << solved.error().ToString();
    EXPECT_EQ(solved->poses.num_placed, 10);
    EXPECT_LT(LargestError(made), 0.1);
    EXPECT_THAT(PairsOf(solved->poses.outlier_edges), IsSupersetOf(kLookAlike));
    EXPECT_THAT(solved->poses.contests, IsEmpty());
  }
}

// Of a relative pose, no third view says much.
class HardlyKnows : public ScaleEstimator {
 public:
  HardlyKnows(const ViewPair& pair, std::shared_ptr<const ScaleEstimator> inner)
      : ScaleEstimator(inner->kinds()), pair_(pair), inner_(std::move(inner)) {}

 protected:
  Result<ScaleRatio> Judge(const TripletView& triplet,
                           const TripletEvidence& evidence) const override {
    Result<ScaleRatio> ratio = inner_->Estimate(triplet, evidence);
    const auto& [first, middle, last] = triplet.views;
    if (ratio && (OrderedPair(first, middle) == pair_ ||
                  OrderedPair(middle, last) == pair_)) {
      ratio->log10_nfa = std::max(ratio->log10_nfa, -4.0);
    }
    return ratio;
  }

 private:
  ViewPair pair_;
  std::shared_ptr<const ScaleEstimator> inner_;
};

TEST(SettleContests, LinksThatNoThirdViewBearsOutDoNotEndAContest) {
  SyntheticScene made = TwoPlacesThatLookAlike(kHalfTurned, -80, -50);
  made.scene.relative_poses.erase(kTrue[1]);
  SolveOptions options;
  options.adjust = false;
  options.scale_estimator =
      std::make_shared<HardlyKnows>(kTrue[0], options.scale_estimator);
  const auto solved = SolveScene(&made.scene, options, RunContext(), nullptr);
  ASSERT_TRUE(solved) << solved.error().ToString();
  ASSERT_EQ(solved->poses.contests.size(), 1u);
  EXPECT_THAT(solved->poses.contests[0].contradictions, ElementsAre(kTrue[0]));
}

TEST(SettleContests, WhatNoThirdViewBearsOutContestsNothing) {
  SyntheticScene made = TwoPlacesThatLookAlike(kHalfTurned, -50, -70);
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
