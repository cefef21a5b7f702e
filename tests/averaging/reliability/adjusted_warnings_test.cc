#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "averaging/reliability/well_measured_scene.h"
#include "lowlap/averaging/reliability/internal/find_reliability_warnings.h"
#include "lowlap/averaging/scene_poses.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// The ratios of the scene times a factor, to 2 %.
AdjustedEvidence Adjusted(const Scene& scene, double log_difference) {
  AdjustedEvidence adjusted;
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    adjusted.ratios[ratio.views] = {ratio.log_ratio + log_difference, 0.02};
  }
  return adjusted;
}

TEST(AdjustedWarnings, AnAdjustmentSharpensTheRatiosThatItBearsOut) {
  SyntheticScene synthetic = WellMeasuredScene("chain");
  Scene& scene = synthetic.scene;
  ScaleRatio& ratio = *FindRatio({3, 4, 5}, &scene);
  ratio.log_ratio_stddev = 0.3;
  const auto summary = SolveScenePoses(&scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  ASSERT_EQ(summary->reliability_warnings.size(), 1u);
  EXPECT_EQ(summary->reliability_warnings[0].reason, WarningReason::kWeakScale);
  FirmEvidence firm;
  EXPECT_THAT(FindReliabilityWarnings(scene, *summary->agreement,
                                      Adjusted(scene, 0.5), &firm),
              IsEmpty());
  EXPECT_EQ(firm.ratios.size(), scene.scale_ratios.size());
  // What contradicts the ratio does not sharpen it, nor does precision make up
  // for evidence.
  EXPECT_EQ(FindReliabilityWarnings(scene, *summary->agreement,
                                    Adjusted(scene, 1), &firm)
                .size(),
            1u);
  ratio.log10_nfa = -1;
  EXPECT_EQ(FindReliabilityWarnings(scene, *summary->agreement,
                                    Adjusted(scene, 0), &firm)
                .size(),
            1u);
}

// Whatever a relative pose tells, the structure may determine the direction;
// but not by chance, nor where it contradicts what the views share.
TEST(AdjustedWarnings, AnAdjustmentDeterminesWhatPosesDoNotTell) {
  SyntheticScene synthetic = WellMeasuredScene("window:2");
  Scene& scene = synthetic.scene;
  MakeVague({{5, 7}, {6, 7}}, &scene);
  const auto summary = SolveScenePoses(&scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  ASSERT_EQ(summary->reliability_warnings.size(), 1u);
  AdjustedEvidence adjusted;
  FirmEvidence firm;
  const auto count_warnings = [&] {
    return FindReliabilityWarnings(scene, *summary->agreement, adjusted, &firm)
        .size();
  };
  adjusted.direction_stddevs_rad = {{{5, 7}, 0.02}, {{6, 7}, 0.02}};
  EXPECT_EQ(count_warnings(), 1u);
  adjusted.evidence_of_pairs = {{{5, 7}, -2}, {{6, 7}, -2}};
  EXPECT_EQ(count_warnings(), 1u);
  adjusted.evidence_of_pairs = {{{5, 7}, -4}, {{6, 7}, -4}};
  EXPECT_EQ(count_warnings(), 0u);
  adjusted.contradicted = {7};
  EXPECT_EQ(count_warnings(), 1u);
  adjusted.contradicted.clear();
  adjusted.direction_stddevs_rad = {{{5, 7}, 0.2}, {{6, 7}, 0.2}};
  EXPECT_EQ(count_warnings(), 1u);
}

TEST(AdjustedWarnings, TheStructureMayHoldTheScaleThatARatioHardlyTells) {
  SyntheticScene synthetic = WellMeasuredScene("chain");
  Scene& scene = synthetic.scene;
  const ViewTriplet last = {5, 6, 7};
  const auto weak = std::find_if(
      scene.scale_ratios.begin(), scene.scale_ratios.end(),
      [&](const ScaleRatio& ratio) { return ratio.views == last; });
  ASSERT_NE(weak, scene.scale_ratios.end());
  const ScaleRatio strong = *weak;
  weak->log10_nfa = -1;
  const auto summary = SolveScenePoses(&scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  AdjustedEvidence adjusted;
  const auto is_weak = [&] {
    FirmEvidence firm;
    const auto warnings =
        FindReliabilityWarnings(scene, *summary->agreement, adjusted, &firm);
    return warnings.size() == 1 &&
           warnings[0].reason == WarningReason::kWeakScale;
  };
  adjusted.ratios[last] = {weak->log_ratio, 0.02};
  EXPECT_TRUE(is_weak());
  adjusted.evidence_of_triplets[last] = -2;
  EXPECT_TRUE(is_weak());
  adjusted.evidence_of_triplets[last] = -4;
  EXPECT_FALSE(is_weak());
  adjusted.contradicted = {6};
  EXPECT_TRUE(is_weak());
  adjusted.contradicted.clear();
  adjusted.ratios[last].log_ratio_stddev = 0.2;
  EXPECT_TRUE(is_weak());
  adjusted.ratios[last].log_ratio_stddev = 0.02;
  // Most of its candidates contradict it.
  for (KindSupport& kind : weak->kinds) kind.candidates = 3 * kind.inliers;
  EXPECT_TRUE(is_weak());
  adjusted.measured_again[last] = strong;
  EXPECT_FALSE(is_weak());
  adjusted.measured_again[last].log_ratio += 0.15;
  EXPECT_TRUE(is_weak());
  adjusted.measured_again[last] = *weak;
  EXPECT_TRUE(is_weak());
}

TEST(AdjustedWarnings, AnAdjustmentDeterminesWhatMatchesDoNotTell) {
  SyntheticScene synthetic = WellMeasuredScene("chain");
  Scene& scene = synthetic.scene;
  const auto summary = SolveScenePoses(&scene, PoseOptions(), RunContext());
  ASSERT_TRUE(summary);
  SolutionAgreement agreement = *summary->agreement;
  agreement.untold = {{6, 7}};
  FirmEvidence firm;
  const auto without = FindReliabilityWarnings(scene, agreement, {}, &firm);
  ASSERT_EQ(without.size(), 1u);
  EXPECT_EQ(without[0].reason, WarningReason::kUntoldPoses);
  EXPECT_THAT(without[0].views, ElementsAre(7));
  AdjustedEvidence adjusted;
  adjusted.evidence_of_pairs = {{{6, 7}, -4}};
  adjusted.direction_stddevs_rad = {{{6, 7}, 0.3}};
  EXPECT_EQ(FindReliabilityWarnings(scene, agreement, adjusted, &firm).size(),
            1u);
  adjusted.direction_stddevs_rad = {{{6, 7}, 0.02}};
  EXPECT_THAT(FindReliabilityWarnings(scene, agreement, adjusted, &firm),
              IsEmpty());
}

// Windows one too far have a wall of their own, behind the house.
TEST(AdjustedWarnings, TheStructureOfCopiesDeterminesNothing) {
  SyntheticScene synthetic = WellMeasuredScene("window:2");
  Scene& scene = synthetic.scene;
  AdjustedEvidence adjusted;
  const std::vector<ViewPair> of_copies = {{5, 7}, {6, 7}};
  for (const ViewPair& views : of_copies) {
    adjusted.evidence_of_pairs[views] = -40;
    adjusted.direction_stddevs_rad[views] = 0.001;
  }
  const auto warnings_with = [&](PoseWeakness weakness) {
    for (const ViewPair& views : of_copies) {
      scene.relative_poses.at(views).weakness = weakness;
    }
    Scene solved = scene;
    const auto summary = SolveScenePoses(&solved, PoseOptions(), RunContext());
    EXPECT_TRUE(summary);
    FirmEvidence firm;
    return FindReliabilityWarnings(scene, *summary->agreement, adjusted, &firm);
  };
  EXPECT_THAT(warnings_with(PoseWeakness::kSurroundings), IsEmpty());
  const auto warnings = warnings_with(PoseWeakness::kRepeats);
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].reason, WarningReason::kUntoldPoses);
  EXPECT_THAT(warnings[0].views, ElementsAre(7));
}

}  // namespace
}  // namespace lowlap
