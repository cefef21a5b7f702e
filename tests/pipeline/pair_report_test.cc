#include "lowlap/pipeline/pair_report.h"

#include <gmock/gmock.h>

namespace lowlap {
namespace {

using ::testing::HasSubstr;

TEST(ExplainNoPose, NamesThePairWithTheMostMatches) {
  PairReport few, many;
  few.views = {0, 1};
  few.num_point_matches = 3;
  few.reason = "too few";
  many.views = {1, 2};
  many.num_point_matches = 2;
  many.num_line_matches = 9;
  many.reason = "no motion";
  const std::string text = ExplainNoPose({few, many});
  EXPECT_THAT(text, HasSubstr("of 2, views 1 and 2 match most"));
  EXPECT_THAT(text, HasSubstr("(2 points, 9 lines): no motion"));
}

TEST(ExplainNoPose, SaysThatNothingMatches) {
  EXPECT_THAT(ExplainNoPose({}), HasSubstr("none has matches"));
}

}  // namespace
}  // namespace lowlap
