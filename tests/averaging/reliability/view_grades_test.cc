#include "lowlap/averaging/reliability/internal/view_grades.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <set>

#include "lowlap/averaging/reliability/internal/pose_warnings.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

PoseSummary SixOfSeven() {
  PoseSummary summary;
  summary.num_views = 7;
  summary.num_placed = 6;
  summary.components = {{0, 1, 2, 3, 4, 5}, {6}};
  summary.unplaced = {6};
  return summary;
}

ReliabilityWarning Warning(WarningReason reason, std::vector<ViewId> views) {
  ReliabilityWarning warning;
  warning.reason = reason;
  warning.views = std::move(views);
  return warning;
}

TEST(ViewGrades, WithoutAWarningPlacedViewsAreFirm) {
  const auto grades = GradeViews(SixOfSeven());
  ASSERT_EQ(grades.size(), 7u);
  for (const auto& [view, graded] : grades) {
    EXPECT_EQ(graded.grade,
              view == ViewId(6) ? ViewGrade::kUnplaced : ViewGrade::kFirm);
    EXPECT_THAT(graded.reasons, IsEmpty());
  }
}

TEST(ViewGrades, EveryWarningThatNamesAViewIsAReasonOnce) {
  PoseSummary summary = SixOfSeven();
  summary.contested = {{{0, 1}, {}, {1}}};
  summary.contests = {{{}, {}, {1, 2}}, {{}, {}, {2}}};
  summary.reliability_warnings = {Warning(WarningReason::kLostFeatures, {2, 6}),
                                  Warning(WarningReason::kUnheld, {3})};
  const auto grades = GradeViews(summary);
  EXPECT_THAT(grades.at(1).reasons, ElementsAre("contested_link", "contest"));
  EXPECT_THAT(grades.at(2).reasons, ElementsAre("contest", "lost_features"));
  EXPECT_THAT(grades.at(3).reasons, ElementsAre("unheld"));
  EXPECT_EQ(grades.at(4).grade, ViewGrade::kFirm);
  // What is not placed has no place to doubt.
  EXPECT_EQ(grades.at(6).grade, ViewGrade::kUnplaced);
  EXPECT_THAT(grades.at(6).reasons, IsEmpty());
}

// The report marks the views that a text names.
TEST(ViewGrades, AreThoseOfTheWarningsInWords) {
  PoseSummary summary = SixOfSeven();
  summary.contested = {{{0, 1}, {}, {1}}};
  summary.contests = {{{}, {}, {2}}};
  summary.reliability_warnings = {
      Warning(WarningReason::kLostFeatures, {3}),
      Warning(WarningReason::kDoubtfulNeighbors, {4})};
  LoopClosing shared_out, cut;
  shared_out.edges = {{0, 1}, {1, 2}, {0, 2}};
  cut.edges = {{2, 3}, {3, 5}, {2, 5}};
  cut.left_out = ViewPair{3, 5};
  summary.loops = {shared_out, cut};
  summary.weak_ratios = {{0, 1, 2}};
  summary.kept_outliers = {{{0, 5}, OutlierReason::kDirection, 9}};
  std::set<ViewId> named, not_firm;
  for (const PoseWarning& warning : PoseWarningsByView(summary, Scene())) {
    named.insert(warning.views.begin(), warning.views.end());
  }
  for (const auto& [view, graded] : GradeViews(summary)) {
    if (graded.grade != ViewGrade::kFirm) not_firm.insert(view);
  }
  EXPECT_THAT(not_firm, ElementsAre(1, 2, 3, 4, 5, 6));
  EXPECT_EQ(named, not_firm);
}

}  // namespace
}  // namespace lowlap
