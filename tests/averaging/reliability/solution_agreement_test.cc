#include "lowlap/averaging/reliability/internal/solution_agreement.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "averaging/reliability/well_measured_scene.h"
#include "lowlap/averaging/reliability/internal/view_grades.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using ::testing::IsEmpty;
using ::testing::Not;

SolutionAgreement AgreementWithTruth(const SyntheticScene& synthetic,
                                     const std::set<ViewTriplet>& weak) {
  return FindAgreement(synthetic.scene,
                       MakeTranslationProblem(
                           synthetic.scene, TrueRotations(synthetic), {}, weak),
                       TrueCenters(synthetic), {}, {});
}

// A walk along a line, of which ratios alone tell the lengths.
SyntheticScene Walk(double log_error, int num_inliers) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kCollinear;
  options.num_views = 8;
  options.pairs = "window:2";
  SyntheticScene synthetic = SceneWithTrueRatios(options);
  for (auto& entry : synthetic.scene.relative_poses) {
    entry.second.log10_nfa = -100;
  }
  std::vector<ScaleRatio> ratios;
  for (ScaleRatio ratio : synthetic.scene.scale_ratios) {
    const std::uint32_t first = ratio.views.first.value();
    if (!(ratio.views == ViewTriplet{first, first + 1, first + 2})) continue;
    ratio.kinds = {{"lines", 20, 20}};
    if (first == 3) {
      ratio.kinds = {{"lines", 20, num_inliers}};
      ratio.log_ratio += log_error;
    }
    ratios.push_back(ratio);
  }
  synthetic.scene.scale_ratios = ratios;
  return synthetic;
}

std::set<ViewId> FirmViews(Scene scene) {
  const auto summary = SolveScenePoses(&scene, PoseOptions(), RunContext());
  EXPECT_TRUE(summary);
  std::set<ViewId> firm;
  for (const auto& [view, graded] : GradeViews(*summary)) {
    if (graded.grade == ViewGrade::kFirm) firm.insert(view);
  }
  return firm;
}

// However small the stated deviation of a weak ratio is.
TEST(SolutionAgreement, AWeakRatioThatIsFarOffIsRejected) {
  for (const double stddev : {0.001, 0.02, 0.2}) {
    SyntheticOptions options;
    options.num_views = 6;
    options.pairs = "chain";
    SyntheticScene synthetic = SceneWithTrueRatios(options);
    const ViewTriplet views = {2, 3, 4};
    for (ScaleRatio& ratio : synthetic.scene.scale_ratios) {
      if (!(ratio.views == views)) continue;
      ratio.verdict = RatioVerdict::kNotMeaningful;
      ratio.log_ratio += 1.5;
      ratio.log_ratio_stddev = stddev;
    }
    const SolutionAgreement agreement = AgreementWithTruth(synthetic, {views});
    EXPECT_THAT(agreement.rejected_ratios, Contains(views)) << stddev;
    EXPECT_THAT(agreement.agreeing_ratios, Not(Contains(views))) << stddev;
  }
}

TEST(SolutionAgreement, TrianglesOnALineAreFlat) {
  EXPECT_EQ(AgreementWithTruth(Walk(0, 20), {}).flat.size(), 6u);
  SyntheticOptions options;
  options.num_views = 8;
  options.pairs = "window:2";
  SyntheticScene room = SceneWithTrueRatios(options);
  StatePreciseDirections(&room.scene);
  EXPECT_THAT(AgreementWithTruth(room, {}).flat, IsEmpty());
}

// Views side by side, far from the others.
TEST(SolutionAgreement, TrianglesWithAShortSideAreNarrow) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kTwins;
  options.twin_baseline_m = 1e-4;
  options.num_views = 8;
  options.pairs = "window:2";
  const SolutionAgreement agreement =
      AgreementWithTruth(SceneWithTrueRatios(options), {});
  EXPECT_THAT(agreement.narrow, Contains(ViewTriplet{0, 2, 1}));
  EXPECT_THAT(agreement.narrow, Contains(ViewTriplet{2, 1, 3}));
}

// Directions along a line do not confirm it, right or wrong.
TEST(SolutionAgreement, ViewsOfAWalkThatHangOnAWeakRatioAreNotFirm) {
  for (const double log_error : {0.0, 0.7}) {
    EXPECT_EQ(FirmViews(Walk(log_error, 20).scene).size(), 8u);
    EXPECT_EQ(FirmViews(Walk(log_error, 4).scene).size(), 5u);
  }
}

}  // namespace
}  // namespace lowlap
