#pragma once

#include <map>
#include <string>
#include <vector>

#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/ids.h"

namespace lowlap {

/// How far the place of a view can be trusted.
enum class ViewGrade {
  kUnplaced,
  kDoubtful,  // a warning names it
  kFirm,
};

/// What the grade kFirm promises: a camera that is no further off than this
/// share of the scene's size.
inline constexpr double kFirmReach = 0.05;

/// "unplaced", "doubtful", "firm".
const char* ViewGradeName(ViewGrade grade);

struct GradedView {
  ViewGrade grade = ViewGrade::kFirm;
  /// Of kDoubtful: "contested_link", "contest", "open_loop" and those of
  /// WarningReasonName, each once.
  std::vector<std::string> reasons;
};

/// Every view of the summary. This is the one rule that says which cameras are
/// doubtful: the console, summary.json and `--strict` go by it; the views that
/// the report marks, those that a warning names, are the same.
std::map<ViewId, GradedView> GradeViews(const PoseSummary& summary);

/// What is said of views, in the order in which it is said.
struct ViewDoubt {
  std::string reason;
  std::vector<ViewId> views;
};
std::vector<ViewDoubt> ViewDoubts(const PoseSummary& summary);

}  // namespace lowlap
