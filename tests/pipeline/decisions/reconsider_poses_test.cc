#include "lowlap/pipeline/internal/decisions/reconsider_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

using ::testing::IsEmpty;

SyntheticOptions Room(const std::string& pairs) {
  SyntheticOptions options;
  options.num_views = 12;
  options.pairs = pairs;
  options.noise_px = 0.5;
  options.pose_noise_factor = 1;
  options.seed = 4;
  return options;
}

double ErrorDeg(const SyntheticScene& synthetic, const RelativePose& pose) {
  const RigidTransform motion =
      synthetic.true_poses.at(pose.views.second).CamFromWorld() *
      synthetic.true_poses.at(pose.views.first).CamFromWorld().Inverse();
  return DegFromRad(RotationAngleBetween(motion.rotation, pose.rotation));
}

// Leaves a pair `count` of its point matches and turns its pose.
RelativePose& Spoil(const ViewPair& views, std::size_t count, double angle_deg,
                    Scene* scene) {
  RelativePose& pose = scene->relative_poses.at(views);
  pose.point_inliers.resize(std::min(count, pose.point_inliers.size()));
  pose.line_inliers.clear();
  pose.rotation =
      RotationFromAngleAxis(Vec3(0, RadFromDeg(angle_deg), 0)) * pose.rotation;
  return pose;
}

void ExpectUnchanged(Scene scene) {
  const auto before = scene.relative_poses;
  const auto reconsidered =
      ReconsiderPoses(&scene, PoseOptions(), RunContext());
  ASSERT_TRUE(reconsidered);
  EXPECT_THAT(*reconsidered, IsEmpty());
  EXPECT_EQ(scene.relative_poses, before);
}

TEST(ReconsiderPoses, TheLoopAndFewMatchesCorrectAPose) {
  const SyntheticScene synthetic = *Simulate(Room("cycle"));
  Scene scene = synthetic.scene;
  const ViewPair views{4, 5};
  RelativePose& pose = Spoil(views, 20, 7, &scene);
  pose.alternatives.push_back({pose.rotation, pose.direction, -1, {}});
  RunContext context;
  const auto reconsidered = ReconsiderPoses(&scene, PoseOptions(), context);
  ASSERT_TRUE(reconsidered);
  const auto found =
      std::find_if(reconsidered->begin(), reconsidered->end(),
                   [&](const auto& other) { return other.views == views; });
  ASSERT_NE(found, reconsidered->end());
  EXPECT_NEAR(found->rotation_deg, 7, 1.5);
  EXPECT_THAT(scene.relative_poses.at(views).alternatives, IsEmpty());
  // Others may take the optimum of their own few matches.
  for (const auto& entry : scene.relative_poses) {
    EXPECT_LT(ErrorDeg(synthetic, entry.second), 0.7);
  }
  for (const ReconsideredPose& other : *reconsidered) {
    EXPECT_GE(other.gained_digits, 1);
  }
  Scene again = synthetic.scene;
  RelativePose& same = Spoil(views, 20, 7, &again);
  same.alternatives.push_back({same.rotation, same.direction, -1, {}});
  context.num_threads = 2;
  ASSERT_TRUE(ReconsiderPoses(&again, PoseOptions(), context));
  EXPECT_EQ(again.relative_poses, scene.relative_poses);
}

TEST(StartSolution, AReconsideredPoseIsNoLongerOpen) {
  Scene scene = Simulate(Room("cycle"))->scene;
  const ViewPair views{4, 5};
  RelativePose& pose = Spoil(views, 20, 7, &scene);
  // The same motion again: nothing decides between the two.
  pose.alternatives.push_back(
      {pose.rotation, pose.direction, pose.log10_nfa, pose.covariance});
  const auto start = StartSolution(&scene, SolveOptions(), {}, nullptr);
  ASSERT_TRUE(start) << start.error().ToString();
  EXPECT_THAT(start->motions, IsEmpty());
  EXPECT_TRUE(std::any_of(
      start->reconsidered.begin(), start->reconsidered.end(),
      [&](const ReconsideredPose& other) { return other.views == views; }));
  EXPECT_EQ(start->replaced.count(views), 1u);
}

// The pair that is off has matches enough to stay; its neighbour has few, but
// these tell its motion.
TEST(ReconsiderPoses, AWrongPoseElsewhereDoesNotBendARightOne) {
  const SyntheticScene synthetic = *Simulate(Room("cycle"));
  Scene scene = synthetic.scene;
  Spoil({4, 5}, 40, 0, &scene);
  RelativePose& wrong = scene.relative_poses.at({7, 8});
  wrong.rotation = RotationFromAngleAxis(Vec3(0, 0.1, 0)) * wrong.rotation;
  while (wrong.point_inliers.size() < 250) {
    wrong.point_inliers.push_back(wrong.point_inliers.front());
  }
  ASSERT_TRUE(ReconsiderPoses(&scene, PoseOptions(), RunContext()));
  EXPECT_LT(ErrorDeg(synthetic, scene.relative_poses.at({4, 5})), 0.5);
  EXPECT_GT(ErrorDeg(synthetic, scene.relative_poses.at({7, 8})), 5);
}

TEST(ReconsiderPoses, AsksNoPoseOnNoCycle) {
  Scene scene = Simulate(Room("chain"))->scene;
  Spoil({4, 5}, 20, 7, &scene);
  ExpectUnchanged(std::move(scene));
}

// Hosts may give relative poses alone: how far they can be trusted is unknown.
TEST(ReconsiderPoses, PosesOfUnknownDeviationSayNothing) {
  Scene scene = Simulate(Room("cycle"))->scene;
  for (auto& entry : scene.relative_poses) entry.second.covariance.reset();
  Spoil({4, 5}, 20, 7, &scene);
  ExpectUnchanged(std::move(scene));
}

TEST(ReconsiderPoses, AGraphWithoutMatchesStaysAsItIs) {
  SyntheticOptions options = Room("cycle");
  options.points_per_wall = options.lines_per_wall = 0;
  options.pose_noise_factor = 0;
  options.rotation_noise_deg = 1;
  Scene scene = Simulate(options)->scene;
  for (auto& entry : scene.relative_poses) {
    entry.second.covariance = 1e-6 * Eigen::Matrix<double, 5, 5>::Identity();
  }
  ExpectUnchanged(std::move(scene));
}

// Whether at once, or when a pose has been replaced already.
TEST(ReconsiderPoses, CancelledItLeavesTheSceneAsItWas) {
  int num_stages = 0;
  for (const int stop_after : {0, 1, 2, 3}) {
    Scene scene = Simulate(Room("cycle"))->scene;
    Spoil({4, 5}, 20, 7, &scene);
    const auto before = scene.relative_poses;
    RunContext context;
    num_stages = 0;
    context.progress = [&](const std::string&, std::size_t done, std::size_t) {
      if (done == 0) ++num_stages;
      return num_stages <= stop_after;
    };
    const auto reconsidered = ReconsiderPoses(&scene, PoseOptions(), context);
    if (reconsidered) break;
    EXPECT_EQ(reconsidered.error().code, ErrorCode::kCancelled);
    EXPECT_EQ(scene.relative_poses, before) << stop_after;
  }
  // Directions, a first round, and one more after the replacement at least.
  EXPECT_GE(num_stages, 3);
}

}  // namespace
}  // namespace lowlap
