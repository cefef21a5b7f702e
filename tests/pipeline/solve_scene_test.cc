#include "lowlap/pipeline/solve_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lowlap/evaluation/internal/relative_errors.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/internal/measure/relative_poses.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

SyntheticOptions RoomWithoutTrifocalFeatures(std::uint64_t seed) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kRoom;
  options.num_views = 12;
  options.pairs = "cycle";
  options.trifocal_point_share = 0;
  options.trifocal_line_share = 0;
  options.noise_px = 1.0;
  options.wrong_candidate_share = 0.4;
  options.seed = seed;
  return options;
}

class TrifocalFreeRoom : public ::testing::TestWithParam<std::uint64_t> {};

// No triplet shares a feature: coplanar lines alone carry the scale.
TEST_P(TrifocalFreeRoom, EveryCameraIsPlacedAndRatiosAreRight) {
  SyntheticScene room = *Simulate(RoomWithoutTrifocalFeatures(GetParam()));
  StageLog stages;
  const auto result =
      SolveScene(&room.scene, SolveOptions(), RunContext(), &stages);
  ASSERT_TRUE(result) << result.error().ToString();
  EXPECT_EQ(result->poses.num_placed, 12);
  for (const ScaleRatio& ratio : room.scene.scale_ratios) {
    EXPECT_EQ(ratio.FindKind("points")->candidates, 0);
    EXPECT_EQ(ratio.FindKind("lines")->candidates, 0);
  }
  const ScaleRatioEvaluation ratios =
      EvaluateScaleRatios(room.scene, room.true_poses);
  EXPECT_LT(ratios.abs_log_error.median, 0.03);
  EXPECT_LT(EvaluatePoses(room.scene, room.true_poses).position.max, 0.1);
}

INSTANTIATE_TEST_SUITE_P(Seeds, TrifocalFreeRoom, ::testing::Values(0, 1, 2));

TEST(SolveScene, NoiseFreeScenesAreSolvedExactly) {
  for (const SyntheticKind kind :
       {SyntheticKind::kRoom, SyntheticKind::kRing}) {
    SyntheticOptions options;
    options.kind = kind;
    options.num_views = 8;
    SyntheticScene synthetic = *Simulate(options);
    StageLog stages;
    const auto result =
        SolveScene(&synthetic.scene, SolveOptions(), RunContext(), &stages);
    ASSERT_TRUE(result) << result.error().ToString();
    const PoseEvaluation evaluation =
        EvaluatePoses(synthetic.scene, synthetic.true_poses);
    EXPECT_EQ(evaluation.num_solved, 8);
    EXPECT_LT(evaluation.position.max, 1e-5);
  }
}

TEST(SolveScene, EachKindAloneDeterminesTheScale) {
  SyntheticOptions options;
  options.num_views = 8;
  options.pairs = "window:2";
  options.noise_px = 0.5;
  const SyntheticScene synthetic = *Simulate(options);
  for (const std::string kind : {"points", "lines", "coplanar"}) {
    SolveOptions solve;
    ScaleOptions of_kind;
    of_kind.features = {kind};
    solve.scale_estimator = MakeScaleEstimator(of_kind);
    solve.adjust = false;
    Scene scene = synthetic.scene;
    StageLog stages;
    const auto result = SolveScene(&scene, solve, RunContext(), &stages);
    ASSERT_TRUE(result) << result.error().ToString();
    EXPECT_EQ(result->poses.num_placed, 8) << kind;
    EXPECT_LT(EvaluatePoses(scene, synthetic.true_poses).position.mean, 0.1)
        << kind;
  }
}

TEST(SolveScene, AdjustmentDoesNotHarm) {
  SyntheticOptions options;
  options.num_views = 10;
  options.noise_px = 1.0;
  options.rotation_noise_deg = 0.2;
  options.direction_noise_deg = 0.4;
  options.wrong_point_share = 0.1;
  options.wrong_line_share = 0.1;
  SyntheticScene synthetic = *Simulate(options);
  StageLog stages;
  const auto result =
      SolveScene(&synthetic.scene, SolveOptions(), RunContext(), &stages);
  ASSERT_TRUE(result) << result.error().ToString();
  Scene before = synthetic.scene;
  before.poses = result->poses_before_adjustment;
  EXPECT_LT(EvaluatePoses(synthetic.scene, synthetic.true_poses).position.mean,
            EvaluatePoses(before, synthetic.true_poses).position.mean);
}

TEST(SolveScene, RelativePosesCanBeEstimatedFromTheFeatures) {
  SyntheticOptions options = RoomWithoutTrifocalFeatures(5);
  options.points_per_wall = 200;
  options.wrong_point_share = 0.2;
  SyntheticScene room = *Simulate(options);
  std::map<ViewPair, PairMatches> matches;
  for (const auto& [views, pose] : room.scene.relative_poses) {
    matches[views] = {pose.point_inliers, pose.line_inliers};
  }
  const auto reports = EstimateRelativePoses(
      &room.scene, matches, nullptr, RelativePoseOptions(), RunContext());
  ASSERT_TRUE(reports) << reports.error().ToString();
  EXPECT_EQ(room.scene.relative_poses.size(), matches.size());
  StageLog stages;
  const auto result =
      SolveScene(&room.scene, SolveOptions(), RunContext(), &stages);
  ASSERT_TRUE(result) << result.error().ToString();
  EXPECT_EQ(result->poses.num_placed, 12);
  const ScaleRatioEvaluation ratios =
      EvaluateScaleRatios(room.scene, room.true_poses);
  EXPECT_LT(ratios.abs_log_error.median, 0.03);
}

TEST(SolveScene, InvalidOptionsAreRefusedBeforeAnythingChanges) {
  SyntheticScene synthetic = *Simulate(SyntheticOptions());
  const Scene original = synthetic.scene;
  SolveOptions options;
  options.scale_estimator = nullptr;
  StageLog stages;
  const auto result =
      SolveScene(&synthetic.scene, options, RunContext(), &stages);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kInvalidArgument);
  EXPECT_TRUE(synthetic.scene == original);
}

TEST(SolveScene, NamesViewsWithoutAnIntrinsic) {
  SyntheticScene synthetic = *Simulate(SyntheticOptions());
  synthetic.scene.views.at(1).intrinsic_id = kInvalidId;
  std::vector<std::string> warnings;
  RunContext context;
  context.log = [&](LogLevel level, const std::string& message) {
    if (level == LogLevel::kWarning) warnings.push_back(message);
  };
  StageLog stages;
  ASSERT_TRUE(SolveScene(&synthetic.scene, SolveOptions(), context, &stages));
  EXPECT_THAT(warnings, ::testing::Contains(::testing::AllOf(
                            ::testing::HasSubstr("no intrinsic"),
                            ::testing::HasSubstr(synthetic.scene.NameOf(1)))));
}

TEST(SolveScene, CancellingStopsTheRun) {
  SyntheticScene synthetic = *Simulate(SyntheticOptions());
  RunContext context;
  context.progress = [](const std::string&, std::size_t done, std::size_t) {
    return done < 2;
  };
  StageLog stages;
  const auto result =
      SolveScene(&synthetic.scene, SolveOptions(), context, &stages);
  ASSERT_FALSE(result);
  EXPECT_EQ(result.error().code, ErrorCode::kCancelled);
}

}  // namespace
}  // namespace lowlap
