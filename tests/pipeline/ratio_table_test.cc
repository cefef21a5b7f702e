#include "lowlap/pipeline/internal/output/ratio_table.h"

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
  ratio.kinds = {
      {"points", 4, 3, -10, 1, 0.6}, {"lines"}, {"odometry", 7, 0, 0, 0, 0.4}};
  const RatioTable table = MakeRatioTable({ratio});
  EXPECT_THAT(
      table.columns,
      ElementsAre("ratio", "95 % from", "to", "log10 NFA", "points", "lines",
                  "odometry", "info %", "second mode", "verdict"));
  EXPECT_THAT(table.rows,
              ElementsAre(ElementsAre("2.0000", "1.8182", "2.2000", "-12.3",
                                      "3/4", "0/0", "0/7", "60/0/40",
                                      "0.5000 (-3.0)", "meaningful")));
}

TEST(RatioTable, KindsThatWereNotAskedShowADash) {
  ScaleRatio first, second;
  first.verdict = second.verdict = RatioVerdict::kMeaningful;
  first.kinds = {{"points", 4, 3}};
  second.kinds = {{"points", 5, 2}, {"odometry", 1, 1}};
  const RatioTable table = MakeRatioTable({first, second});
  EXPECT_THAT(KindNames({first, second}), ElementsAre("points", "odometry"));
  ASSERT_EQ(table.columns.size(), 9u);
  EXPECT_EQ(table.rows[0][4], "3/4");
  EXPECT_EQ(table.rows[0][5], "-");
  EXPECT_EQ(table.rows[0][6], "0/-");
  EXPECT_EQ(table.rows[1][5], "1/1");
}

TEST(RatioTable, NoCandidatesShowNoRatio) {
  ScaleRatio other;
  other.kinds = {{"points"}};
  const RatioTable table = MakeRatioTable({ScaleRatio{}, other});
  const std::vector<std::string>& row = table.rows[0];
  ASSERT_EQ(row.size(), table.columns.size());
  EXPECT_EQ(row.back(), "no_candidates");
  for (std::size_t n = 0; n + 1 < row.size(); ++n) EXPECT_EQ(row[n], "-");
}

}  // namespace
}  // namespace lowlap
