#include "lowlap/merge/merge_models.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>

#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/geometry/internal/rotation.h"
#include "merge/parts.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

Result<SolveResult> Merge(Scene* scene, const std::vector<PartialModel>& models,
                          const SolveOptions& options = {},
                          std::vector<ScaleRatio>* measured = nullptr) {
  std::vector<ModelCheck> checks;
  for (const PartialModel& model : models) {
    auto check = CheckModel(*scene, model, options, RunContext());
    if (!check) return tl::unexpected<Error>(check.error());
    if (measured != nullptr) {
      measured->insert(measured->end(), check->measured_ratios.begin(),
                       check->measured_ratios.end());
    }
    checks.push_back(std::move(*check));
  }
  return MergeModels(scene, models, checks, options, RunContext(), nullptr);
}

Similarity AnotherFrame() {
  Similarity frame;
  frame.scale = 0.21;
  frame.rotation = RotationFromAngleAxis(Vec3(-0.7, 2.1, 0.4));
  frame.translation = Vec3(-3, 8, 1);
  return frame;
}

// Views 0-3 and 5-8, and view 4 that no model has.
std::vector<PartialModel> TwoParts(const SyntheticScene& made) {
  PartialModel second = PartOf(made.true_poses, Range(5, 8), "second");
  second.poses = Moved(second.poses, AnotherFrame());
  return {PartOf(made.true_poses, Range(0, 3), "first"), second};
}

double MeanError(const Scene& scene, const SyntheticScene& made) {
  const PoseEvaluation evaluation = EvaluatePoses(scene, made.true_poses);
  EXPECT_EQ(evaluation.num_solved, 9);
  return evaluation.position.mean;
}

class MergeModelsTest : public ::testing::TestWithParam<std::uint64_t> {
 protected:
  SyntheticScene made_ = NoisyChain(GetParam());
};

TEST_P(MergeModelsTest, TwoPartsAndAViewThatNobodyPlacedBecomeOne) {
  const auto measured = made_.scene.relative_poses;
  const auto merged = Merge(&made_.scene, TwoParts(made_));
  ASSERT_THAT(merged, testing::IsOk());
  EXPECT_EQ(merged->poses.num_placed, 9);
  EXPECT_LT(MeanError(made_.scene, made_), 0.02);
  EXPECT_EQ(made_.scene.relative_poses, measured);
}

// The models stand in for what was measured, but are no measurements.
TEST_P(MergeModelsTest, LeavesTheRatiosThatWereMeasured) {
  std::vector<ScaleRatio> measured;
  const auto merged = Merge(&made_.scene, TwoParts(made_), {}, &measured);
  ASSERT_THAT(merged, testing::IsOk());
  for (const ScaleRatio& ratio : made_.scene.scale_ratios) {
    EXPECT_EQ(ratio.FindKind("model"), nullptr);
  }
  ASSERT_FALSE(measured.empty());
  for (const ScaleRatio& ratio : measured) {
    EXPECT_THAT(made_.scene.scale_ratios, ::testing::Contains(ratio));
  }
  const RatioSummary summary = SummarizeRatios(made_.scene.scale_ratios);
  EXPECT_EQ(merged->ratios.num_triplets, summary.num_triplets);
  EXPECT_EQ(merged->ratios.num_meaningful, summary.num_meaningful);
}

// Before the adjustment, the places inside a part are those of the model.
TEST_P(MergeModelsTest, PartsKeepTheirShapeUntilAllIsAdjusted) {
  SolveOptions options;
  options.adjust = false;
  ASSERT_THAT(Merge(&made_.scene, TwoParts(made_), options), testing::IsOk());
  for (const auto& views : {Range(0, 3), Range(5, 8)}) {
    const PoseEvaluation part =
        EvaluatePoses(made_.scene, PartOf(made_.true_poses, views).poses);
    EXPECT_LT(part.position.max, 1e-3);
    EXPECT_LT(part.rotation_deg.max, 0.02);
  }
}

TEST_P(MergeModelsTest, FramesAndUnitsOfPartsMakeNoDifference) {
  // The adjustment multiplies rounding.
  SolveOptions options;
  options.adjust = false;
  Scene other = made_.scene;
  std::vector<PartialModel> models = TwoParts(made_);
  ASSERT_THAT(Merge(&made_.scene, models, options), testing::IsOk());
  models[0].poses = Moved(models[0].poses, AnotherFrame());
  models[1].poses = Moved(models[1].poses, AnotherFrame());
  ASSERT_THAT(Merge(&other, models, options), testing::IsOk());
  EXPECT_LT(
      EvaluatePoses(other, GroundTruthFromScene(made_.scene)).position.max,
      1e-6);
}

TEST_P(MergeModelsTest, APartThatWasGluedWronglyIsTakenApart) {
  const PartialModel model =
      Glued(PartOf(made_.true_poses, Range(0, 8)), 5, 1.6,
            RotationFromAngleAxis(RadFromDeg(20) * Vec3::UnitY()));
  const auto merged = Merge(&made_.scene, {model});
  ASSERT_THAT(merged, testing::IsOk());
  EXPECT_LT(MeanError(made_.scene, made_), 0.02);
}

INSTANTIATE_TEST_SUITE_P(Seeds, MergeModelsTest, ::testing::Values(0, 1, 2));

// Coplanar lines are all that ties the parts: no feature is in three views, and
// no view of one part is related to one of the other.
TEST(MergeModels, CoplanarLinesTieParts) {
  SyntheticOptions options;
  options.num_views = 9;
  options.pairs = "chain";
  options.noise_px = 0.5;
  options.trifocal_point_share = 0;
  options.trifocal_line_share = 0;
  SyntheticScene made = *Simulate(options);
  const auto merged = Merge(&made.scene, TwoParts(made));
  ASSERT_THAT(merged, testing::IsOk());
  EXPECT_LT(MeanError(made.scene, made), 0.05);
}

// Keeps, of the relative poses between the parts, those of `kept`.
void Sever(const std::vector<ViewPair>& kept, SyntheticScene* made) {
  auto& pairs = made->scene.relative_poses;
  for (auto pair = pairs.begin(); pair != pairs.end();) {
    const bool across = pair->first.first <= 4 && pair->first.second >= 4;
    const bool stays =
        std::find(kept.begin(), kept.end(), pair->first) != kept.end();
    pair = across && !stays ? pairs.erase(pair) : std::next(pair);
  }
}

TEST(MergeModels, RefusesPartsThatNoRelativePoseJoins) {
  SyntheticScene made = NoisyChain(0);
  Sever({}, &made);
  EXPECT_THAT(
      Merge(&made.scene, TwoParts(made)),
      testing::IsError(ErrorCode::kInsufficientData,
                       "no relative pose joins them to any other view"));
}

// A relative pose says nothing of the parts' scales.
TEST(MergeModels, RefusesPartsWithoutARatioBetweenThem) {
  SyntheticScene made = NoisyChain(0);
  Sever({{3, 5}}, &made);
  RelativePose& bridge = made.scene.relative_poses.at({3, 5});
  bridge.point_inliers.clear();
  bridge.line_inliers.clear();
  EXPECT_THAT(Merge(&made.scene, TwoParts(made)),
              testing::IsError(ErrorCode::kInsufficientData,
                               "across, 0 are meaningful"));
}

// As between photographs of different places: what little relates them is
// false.
TEST(MergeModels, RefusesPartsThatFalseRelativePosesJoin) {
  SyntheticScene made = NoisyChain(0);
  Sever({{2, 5}, {3, 5}, {3, 6}}, &made);
  auto& pairs = made.scene.relative_poses;
  // Relative poses of other views, far from parallel to one another.
  const auto replace = [&](ViewPair views, ViewPair by) {
    pairs[views].rotation = pairs.at(by).rotation.transpose();
    pairs[views].direction = pairs.at(by).rotation * pairs.at(by).direction;
    pairs[views].views = views;
    pairs[views].log10_nfa = -2;
    pairs[views].covariance = pairs.at(by).covariance;
  };
  replace({2, 5}, {0, 2});
  replace({3, 5}, {1, 2});
  replace({3, 6}, {6, 8});
  EXPECT_THAT(Merge(&made.scene, TwoParts(made)),
              testing::IsError(ErrorCode::kInsufficientData, "second: "));
}

TEST(MergeModels, RefusesAModelThatNothingBearsOut) {
  SyntheticScene made = NoisyChain(0);
  PartialModel wrong = PartOf(made.true_poses, Range(5, 8), "wrong");
  std::uint32_t n = 0;
  for (auto& entry : wrong.poses) {
    entry.second.rotation = RotationFromAngleAxis(Vec3(1.0 * n++, 0.5, 0));
  }
  EXPECT_THAT(Merge(&made.scene, {PartOf(made.true_poses, Range(0, 3)), wrong}),
              testing::IsError(ErrorCode::kInsufficientData, "wrong: "));
}

// Two parts that share cameras have their scales from these.
TEST(MergeModels, PartsMayShareCameras) {
  SyntheticScene made = NoisyChain(0);
  PartialModel second = PartOf(made.true_poses, Range(3, 8));
  second.poses = Moved(second.poses, AnotherFrame());
  const auto merged =
      Merge(&made.scene, {PartOf(made.true_poses, Range(0, 5)), second});
  ASSERT_THAT(merged, testing::IsOk());
  EXPECT_LT(MeanError(made.scene, made), 0.02);
}

TEST(MergeModels, NeedsACheckOfEachModel) {
  SyntheticScene made = NoisyChain(0);
  EXPECT_THAT(MergeModels(&made.scene, TwoParts(made), {ModelCheck()},
                          SolveOptions(), RunContext(), nullptr),
              testing::IsError(ErrorCode::kInvalidArgument, "a check of each"));
}

}  // namespace
}  // namespace lowlap
