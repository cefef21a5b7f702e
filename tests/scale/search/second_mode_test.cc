#include "lowlap/scale/internal/search/second_mode.h"

#include <gtest/gtest.h>

#include <vector>

#include "lowlap/scale/internal/search/ratio_sweep.h"
#include "scale/even_evidence.h"

namespace lowlap {
namespace {

using testing::Even;
using testing::EvidenceOf;

TEST(HalfSampleMode, IsWhereValuesLieClosest) {
  EXPECT_EQ(HalfSampleMode({3}), 3);
  EXPECT_EQ(HalfSampleMode({3, 5}), 4);
  EXPECT_NEAR(HalfSampleMode({-9, -4, 1.0, 1.01, 1.02, 1.03, 6, 20}), 1.015,
              0.016);
}

TEST(HalfSampleMode, MovesAndGrowsWithTheValues) {
  const std::vector<double> sorted = {-3, -1, 0, 0.25, 0.375, 2, 4, 7, 8};
  std::vector<double> moved;
  for (const double value : sorted) moved.push_back(2 * value + 16);
  EXPECT_EQ(HalfSampleMode(moved), 2 * HalfSampleMode(sorted) + 16);
}

std::optional<RatioOptimum> SecondModeOf(std::vector<double> log_ratios) {
  const RatioSupport support(EvidenceOf({Even(log_ratios, 0.01)}));
  const RatioNfaCriterion criterion(support, {}, NfaForm::kCalibrated);
  return FindSecondMode(support, criterion, SweepRatios(support, criterion));
}

TEST(FindSecondMode, IsTheRatioThatTheOthersAgreeOn) {
  const auto second = SecondModeOf({0, 0, 0, 0, 0, 0, 0, 0, 2, 2, 2, 2, 2, 2});
  ASSERT_TRUE(second.has_value());
  EXPECT_NEAR(second->log_ratio, 2, 0.01);
  EXPECT_LT(second->nfa.log10_nfa, 0);
}

TEST(FindSecondMode, IsNoneWithoutAgreementOrWithTooFew) {
  EXPECT_FALSE(SecondModeOf({0, 0, 0, 0, 0, 0, 0, 0}).has_value());
  EXPECT_FALSE(SecondModeOf({0, 0, 0, 0, 0, 0, 0, 0, 2, 2}).has_value());
  EXPECT_FALSE(
      SecondModeOf({-3, -2, -1, 0, 0, 0, 0, 0, 0, 1, 2, 3}).has_value());
}

}  // namespace
}  // namespace lowlap
