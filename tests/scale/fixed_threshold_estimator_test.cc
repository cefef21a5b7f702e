#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "lowlap/scale/internal/criterion/ratio_nfa.h"
#include "lowlap/scale/scale_estimator.h"
#include "scale/even_evidence.h"

namespace lowlap {
namespace {

using testing::Even;
using testing::EvidenceOf;
using testing::ValidTriplet;

ScaleRatio Judge(const TripletEvidence& evidence, double threshold_px) {
  const auto ratio = FixedThresholdScaleEstimator({}, threshold_px)
                         .Estimate(ValidTriplet(), evidence);
  EXPECT_TRUE(ratio.has_value()) << ratio.error().ToString();
  return *ratio;
}

TEST(FixedThresholdScaleEstimator, TakesTheRatioWithTheMostInliers) {
  // Errors of 0.5 between neighbours of the first three, 0.1 of the last two.
  const TripletEvidence evidence =
      EvidenceOf({Even({0, 0.005, 0.01, 1, 1.001}, 0.01)});
  const ScaleRatio wide = Judge(evidence, 0.6);
  EXPECT_NEAR(wide.log_ratio, 0.005, 1e-3);
  EXPECT_EQ(wide.kinds[0].inliers, 3);
  EXPECT_EQ(wide.verdict, RatioVerdict::kMeaningful);
  const ScaleRatio narrow = Judge(evidence, 0.4);
  EXPECT_NEAR(narrow.log_ratio, 1.0005, 1e-3);
  EXPECT_EQ(narrow.kinds[0].inliers, 2);
}

TEST(FixedThresholdScaleEstimator, OfEqualsTakesTheOneWithTheLeastError) {
  EXPECT_NEAR(
      Judge(EvidenceOf({Even({0, 0.004, 1, 1.002}, 0.01)}), 1).log_ratio, 1.001,
      1e-3);
  EXPECT_NEAR(
      Judge(EvidenceOf({Even({0, 0.002, 1, 1.004}, 0.01)}), 1).log_ratio, 0.001,
      1e-3);
}

TEST(FixedThresholdScaleEstimator, CountsTheInliersOfAllKindsTogether) {
  // Three at 1 in one kind, two at 0 in either.
  const ScaleRatio ratio =
      Judge(EvidenceOf({Even({0, 0.001, 1, 1.001, 1.002}, 0.01), nullptr,
                        Even({0, 0.001, -2}, 0.01)}),
            1);
  EXPECT_NEAR(ratio.log_ratio, 0.0005, 1e-3);
  EXPECT_EQ(ratio.kinds[0].inliers, 2);
  EXPECT_EQ(ratio.kinds[2].inliers, 2);
  for (const KindSupport& kind : ratio.kinds) EXPECT_EQ(kind.threshold_px, 1);
}

TEST(FixedThresholdScaleEstimator, IsMeaningfulAsSoonAsASecondAgrees) {
  EXPECT_EQ(Judge(EvidenceOf({Even({0, 1, 2}, 0.01)}), 1).verdict,
            RatioVerdict::kNotMeaningful);
  EXPECT_EQ(Judge(EvidenceOf({Even({0, 1, 2, 2.005}, 0.01)}), 1).verdict,
            RatioVerdict::kMeaningful);
  EXPECT_EQ(
      Judge(EvidenceOf({Even({0}, 0.01), Even({0.005}, 0.01)}), 1).verdict,
      RatioVerdict::kMeaningful);
  EXPECT_EQ(Judge(EvidenceOf({Even({}, 0.01), nullptr}), 1).verdict,
            RatioVerdict::kNoCandidates);
}

// RANSAC has no measure of chance: the NFA is that of its winner.
TEST(FixedThresholdScaleEstimator, HasTheNfaOfItsWinner) {
  const TripletEvidence evidence =
      EvidenceOf({Even({-1, 0.25, 0.25, 0.25, 0.25, 3}, 0.01)});
  const RatioSupport support(evidence);
  const RatioNfaCriterion criterion(support, ValidTriplet(),
                                    NfaForm::kCalibrated);
  SupportWorkspace workspace;
  EXPECT_EQ(
      Judge(evidence, 1).log10_nfa,
      criterion.Evaluate(0.25, support.Count(0.25, &workspace)).log10_nfa);
  EXPECT_LT(Judge(evidence, 1).log10_nfa, 0);
}

}  // namespace
}  // namespace lowlap
