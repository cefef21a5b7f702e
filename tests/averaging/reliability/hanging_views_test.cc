#include "lowlap/averaging/reliability/internal/hanging_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lowlap {
namespace {

using ::testing::ElementsAre;

// A chain of seven views, every ratio known.
PoseSummary Chain() {
  PoseSummary summary;
  summary.components.resize(1);
  for (std::uint32_t n = 0; n < 7; ++n) {
    summary.components[0].push_back(n);
    if (n > 0) summary.firm_evidence.edges.push_back({n - 1, n});
    if (n > 1) summary.firm_evidence.ratios.push_back({n - 2, n - 1, n});
  }
  return summary;
}

void Doubt(ViewId view, PoseSummary* summary) {
  ReliabilityWarning warning;
  warning.reason = WarningReason::kLostFeatures;
  warning.views = {view};
  summary->reliability_warnings.push_back(warning);
}

TEST(HangingViews, NoneWithoutDoubt) {
  PoseSummary summary = Chain();
  WarnOfHangingViews(&summary);
  EXPECT_TRUE(summary.reliability_warnings.empty());
}

TEST(HangingViews, ThoseBeyondADoubtfulView) {
  PoseSummary summary = Chain();
  Doubt(1, &summary);
  for (int again = 0; again < 2; ++again) {
    WarnOfHangingViews(&summary);
    ASSERT_EQ(summary.reliability_warnings.size(), 2u);
    EXPECT_EQ(summary.reliability_warnings[1].reason,
              WarningReason::kDoubtfulNeighbors);
    EXPECT_THAT(summary.reliability_warnings[1].views, ElementsAre(0));
  }
}

TEST(HangingViews, AllIfNoThreeOfThemHoldEachOther) {
  PoseSummary summary = Chain();
  Doubt(2, &summary);
  Doubt(5, &summary);
  WarnOfHangingViews(&summary);
  ASSERT_EQ(summary.reliability_warnings.size(), 3u);
  EXPECT_THAT(summary.reliability_warnings[2].views,
              ElementsAre(0, 1, 3, 4, 6));
}

TEST(HangingViews, NoneWhereOthersHold) {
  PoseSummary summary = Chain();
  summary.firm_evidence.edges.push_back({0, 2});
  summary.firm_evidence.ratios.push_back({0, 2, 3});
  Doubt(1, &summary);
  WarnOfHangingViews(&summary);
  EXPECT_EQ(summary.reliability_warnings.size(), 1u);
}

// Three views that hold each other, among eight.
TEST(HangingViews, AllOfASmallPart) {
  for (const int num_doubtful : {3, 4, 5}) {
    PoseSummary summary = Chain();
    summary.components[0].push_back(7);
    for (int n = 7; n > 7 - num_doubtful; --n) Doubt(n, &summary);
    WarnOfHangingViews(&summary);
    const std::size_t num_warnings = num_doubtful;
    if (num_doubtful < 5) {
      EXPECT_EQ(summary.reliability_warnings.size(), num_warnings);
      continue;
    }
    ASSERT_EQ(summary.reliability_warnings.size(), num_warnings + 1);
    EXPECT_THAT(summary.reliability_warnings.back().views,
                ElementsAre(0, 1, 2));
  }
}

// Whatever their ids.
TEST(HangingViews, AllOfTwoPartsThatAreAsLarge) {
  PoseSummary summary = Chain();
  Doubt(3, &summary);
  WarnOfHangingViews(&summary);
  ASSERT_EQ(summary.reliability_warnings.size(), 2u);
  EXPECT_THAT(summary.reliability_warnings[1].views,
              ElementsAre(0, 1, 2, 4, 5, 6));
}

}  // namespace
}  // namespace lowlap
