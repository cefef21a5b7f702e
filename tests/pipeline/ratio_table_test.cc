#include "lowlap/pipeline/internal/ratio_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

namespace lowlap {
namespace {

using ::testing::ElementsAre;

TEST(RatioTable, GivesIntervalSupportAndSecondMode) {
  ScaleRatio ratio;
  ratio.verdict = RatioVerdict::kMeaningful;
  ratio.log_ratio = std::log(2.0);
  ratio.log_ratio_stddev = std::log(1.1) / 1.96;
  ratio.log10_nfa = -12.34;
  ratio.second_mode = RatioMode{std::log(0.5), -3.0};
  ratio.points.inliers = 3;
  ratio.points.candidates = 4;
  ratio.points.information_share = 0.6;
  ratio.coplanar.candidates = 7;
  ratio.coplanar.information_share = 0.4;
  EXPECT_THAT(RatioRow(ratio),
              ElementsAre("2.0000", "1.8182", "2.2000", "-12.3", "3/4", "0/0",
                          "0/7", "60/0/40", "0.5000 (-3.0)", "meaningful"));
}

TEST(RatioTable, NoCandidatesShowNoRatio) {
  const std::vector<std::string> row = RatioRow(ScaleRatio{});
  ASSERT_EQ(row.size(), RatioColumns().size());
  EXPECT_EQ(row.back(), "no_candidates");
  for (std::size_t n = 0; n + 1 < row.size(); ++n) EXPECT_EQ(row[n], "-");
}

}  // namespace
}  // namespace lowlap
