#include "lowlap/averaging/reliability/internal/view_grades.h"

#include <algorithm>

namespace lowlap {

const char* ViewGradeName(ViewGrade grade) {
  switch (grade) {
    case ViewGrade::kUnplaced:
      return "unplaced";
    case ViewGrade::kDoubtful:
      return "doubtful";
    case ViewGrade::kFirm:
      return "firm";
  }
  return "";
}

std::vector<ViewDoubt> ViewDoubts(const PoseSummary& summary) {
  std::vector<ViewDoubt> doubts;
  for (const ContestedLink& link : summary.contested) {
    doubts.push_back({"contested_link", link.views});
  }
  for (const Contest& contest : summary.contests) {
    doubts.push_back({"contest", contest.views});
  }
  for (const LoopClosing& loop : summary.loops) {
    doubts.push_back({"open_loop", loop.DoubtfulViews()});
  }
  for (const ReliabilityWarning& warning : summary.reliability_warnings) {
    doubts.push_back({WarningReasonName(warning.reason), warning.views});
  }
  return doubts;
}

std::map<ViewId, GradedView> GradeViews(const PoseSummary& summary) {
  std::map<ViewId, GradedView> grades;
  if (!summary.components.empty()) {
    for (const ViewId view : summary.components.front()) grades[view];
  }
  for (const ViewId view : summary.unplaced) {
    grades[view].grade = ViewGrade::kUnplaced;
  }
  for (const ViewDoubt& doubt : ViewDoubts(summary)) {
    for (const ViewId view : doubt.views) {
      const auto found = grades.find(view);
      if (found == grades.end() ||
          found->second.grade == ViewGrade::kUnplaced) {
        continue;
      }
      GradedView& graded = found->second;
      graded.grade = ViewGrade::kDoubtful;
      std::vector<std::string>& reasons = graded.reasons;
      if (std::find(reasons.begin(), reasons.end(), doubt.reason) ==
          reasons.end()) {
        reasons.push_back(doubt.reason);
      }
    }
  }
  return grades;
}

}  // namespace lowlap
