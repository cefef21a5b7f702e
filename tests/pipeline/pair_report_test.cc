#include "lowlap/pipeline/internal/measure/pair_report.h"

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

TEST(FindUnrelatedViews, NamesWhatKeepsEachViewOut) {
  const auto pair = [](ViewId a, ViewId b, int matches, const char* reason) {
    PairReport report;
    report.views = {a, b};
    report.num_point_matches = matches;
    report.reason = reason;
    return report;
  };
  std::vector<PairReport> pairs = {
      pair(0, 1, 50, ""), pair(1, 2, 9, "few"), pair(2, 3, 4, "fewer"),
      pair(3, 4, 70, "no parallax: turned"), pair(2, 4, 99, "chance")};
  pairs[0].accepted = true;
  pairs[3].no_parallax = true;
  std::map<ViewId, View> all;
  for (const unsigned id : {0, 1, 2, 3, 4, 7, 8}) all[id] = View();
  const auto views = FindUnrelatedViews(
      all, pairs, {{7, Error{ErrorCode::kParse, "no image", "7.jpg", ""}}});
  ASSERT_EQ(views.size(), 5u);
  EXPECT_EQ(views[0].view, 2u);
  EXPECT_EQ(views[0].reason, "chance");
  EXPECT_FALSE(views[0].no_parallax);
  for (const std::size_t n : {1, 2}) {
    EXPECT_EQ(views[n].view, 2 + n);
    EXPECT_TRUE(views[n].no_parallax);
    EXPECT_EQ(views[n].reason, "no parallax: turned");
  }
  EXPECT_EQ(views[3].view, 7u);
  EXPECT_EQ(views[3].reason, "no image");
  EXPECT_EQ(views[4].view, 8u);
  EXPECT_EQ(views[4].reason, "no pair with it was matched");
}

}  // namespace
}  // namespace lowlap
