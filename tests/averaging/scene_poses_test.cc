#include "lowlap/averaging/scene_poses.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <vector>

#include "averaging/true_ratios.h"
#include "lowlap/averaging/reliability/internal/pose_warnings.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

TEST(SolveScenePoses, ExactMeasurementsGiveExactPoses) {
  for (const char* pairs : {"chain", "cycle", "window:2"}) {
    SyntheticOptions options;
    options.num_views = 10;
    options.pairs = pairs;
    SyntheticScene synthetic = SceneWithTrueRatios(options);
    const auto summary =
        SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
    ASSERT_TRUE(summary) << summary.error().ToString();
    EXPECT_EQ(summary->num_placed, 10) << pairs;
    const PoseEvaluation evaluation =
        EvaluatePoses(synthetic.scene, synthetic.true_poses);
    EXPECT_LT(evaluation.position.max, 1e-6) << pairs;
    EXPECT_LT(evaluation.rotation_deg.max, 1e-6) << pairs;
  }
}

TEST(SolveScenePoses, ACycleIsBetterThanItsOpenChain) {
  double chain_error = 0, cycle_error = 0;
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    SyntheticOptions options;
    options.num_views = 16;
    options.rotation_noise_deg = 0.3;
    options.direction_noise_deg = 0.5;
    options.seed = seed;
    SyntheticScene cycle = SceneWithTrueRatios(options);
    Scene chain = cycle.scene;
    chain.relative_poses.erase(ViewPair{0, 15});
    ASSERT_TRUE(SolveScenePoses(&cycle.scene, PoseOptions(), RunContext()));
    ASSERT_TRUE(SolveScenePoses(&chain, PoseOptions(), RunContext()));
    cycle_error += EvaluatePoses(cycle.scene, cycle.true_poses).position.mean;
    chain_error += EvaluatePoses(chain, cycle.true_poses).position.mean;
  }
  EXPECT_LT(cycle_error, chain_error);
}

TEST(SolveScenePoses, AContradictoryRotationIsNamedAndLeftOut) {
  SyntheticOptions options;
  options.num_views = 12;
  options.pairs = "window:3";
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  RelativePose& wrong = synthetic.scene.relative_poses.begin()->second;
  wrong.rotation = RotationFromAngleAxis(Vec3(0.3, 0.1, 0)) * wrong.rotation;
  const auto summary =
      SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  ASSERT_EQ(summary->outlier_edges.size(), 1u);
  EXPECT_EQ(summary->outlier_edges[0].views, wrong.views);
  EXPECT_EQ(summary->outlier_edges[0].reason, OutlierReason::kRotation);
  EXPECT_LT(EvaluatePoses(synthetic.scene, synthetic.true_poses).position.max,
            1e-6);
}

TEST(SolveScenePoses, AContradictoryDirectionIsNamedAndLeftOut) {
  SyntheticOptions options;
  options.num_views = 12;
  options.pairs = "window:3";
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  RelativePose& wrong = synthetic.scene.relative_poses.at({4, 6});
  wrong.direction =
      RotationFromAngleAxis(0.6 * TangentBasis(wrong.direction).col(0)) *
      wrong.direction;
  const auto summary =
      SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  ASSERT_EQ(summary->outlier_edges.size(), 1u);
  EXPECT_EQ(summary->outlier_edges[0].views, wrong.views);
  EXPECT_EQ(summary->outlier_edges[0].reason, OutlierReason::kDirection);
  EXPECT_NEAR(summary->outlier_edges[0].error_deg, DegFromRad(0.6), 2);
  EXPECT_EQ(summary->num_placed, 12);
  EXPECT_FALSE(summary->IsDoubtful());
  EXPECT_LT(EvaluatePoses(synthetic.scene, synthetic.true_poses).position.max,
            1e-6);
}

// Views 0 to 6 hold each other, 7 to 13 are a loop back to them that gives one
// of its joints its scale, and that a false ratio of much evidence opens.
TEST(SolveScenePoses, OnlyContradictionsThatHoldAViewAreKept) {
  SyntheticOptions options;
  options.num_views = 14;
  options.pairs = "all";
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  Scene& scene = synthetic.scene;
  const auto is_there = [](ViewId a, ViewId b) {
    const int first = static_cast<int>(std::min(a, b).value());
    const int second = static_cast<int>(std::max(a, b).value());
    return second < 7 || second == first + 1 || (first == 0 && second == 13);
  };
  for (const auto& entry :
       std::map<ViewPair, RelativePose>(scene.relative_poses)) {
    const ViewPair& views = entry.first;
    if (!is_there(views.first, views.second)) scene.relative_poses.erase(views);
  }
  std::vector<ScaleRatio> ratios;
  for (ScaleRatio ratio : scene.scale_ratios) {
    const ViewTriplet& views = ratio.views;
    if (views == ViewTriplet{10, 11, 12}) ratio.log_ratio += std::log(100);
    if (views == ViewTriplet{7, 8, 9}) continue;
    if (is_there(views.first, views.middle) &&
        is_there(views.middle, views.last)) {
      ratios.push_back(ratio);
    }
  }
  scene.scale_ratios = std::move(ratios);
  RelativePose& wrong = scene.relative_poses.at({2, 4});
  wrong.direction =
      RotationFromAngleAxis(TangentBasis(wrong.direction).col(0)) *
      wrong.direction;
  const auto summary = SolveScenePoses(&scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->num_placed, 14);
  ASSERT_EQ(summary->outlier_edges.size(), 1u);
  EXPECT_EQ(summary->outlier_edges[0].views, (ViewPair{2, 4}));
  EXPECT_FALSE(summary->kept_outliers.empty());
  for (const OutlierEdge& edge : summary->kept_outliers) {
    EXPECT_GT(edge.views.second, ViewId(6));
  }
}

TEST(PoseWarnings, ALoopThatDoesNotCloseIsSaid) {
  SyntheticOptions options;
  options.num_views = 14;
  options.pairs = "cycle";
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  RelativePose& wrong = synthetic.scene.relative_poses.at({5, 6});
  wrong.rotation = RotationFromAngleAxis(Vec3(0, 0.5, 0)) * wrong.rotation;
  const auto summary =
      SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  EXPECT_TRUE(summary->IsDoubtful());
  const auto warnings = PoseWarnings(*summary, synthetic.scene);
  ASSERT_FALSE(warnings.empty());
  EXPECT_THAT(warnings, ::testing::Contains(::testing::HasSubstr(
                            "a loop of 14 relative poses does not close")));
}

TEST(PoseWarnings, NoneWhereAllIsWell) {
  SyntheticOptions options;
  options.num_views = 12;
  options.pairs = "window:2";
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  for (ScaleRatio& ratio : synthetic.scene.scale_ratios) {
    ratio.kinds = {{"lines", 20, 20}};
  }
  const auto summary =
      SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  EXPECT_TRUE(PoseWarnings(*summary, synthetic.scene).empty());
}

TEST(SolveScenePoses, ViewsWithoutAScaleAreListedNotPlaced) {
  SyntheticOptions options;
  options.num_views = 8;
  options.pairs = "chain";
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  for (ScaleRatio& ratio : synthetic.scene.scale_ratios) {
    if (ratio.views.middle == 5) ratio.verdict = RatioVerdict::kNotMeaningful;
  }
  const auto summary =
      SolveScenePoses(&synthetic.scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  EXPECT_EQ(summary->num_placed, 6);
  EXPECT_EQ(summary->unplaced, (std::vector<ViewId>{6, 7}));
  EXPECT_EQ(synthetic.scene.poses.size(), 6u);
}

TEST(SolveScenePoses, ASceneWithoutRelativePosesIsRefused) {
  Scene scene;
  const auto summary = SolveScenePoses(&scene, PoseOptions(), RunContext());
  ASSERT_FALSE(summary);
  EXPECT_EQ(summary.error().code, ErrorCode::kInsufficientData);
}

}  // namespace
}  // namespace lowlap
