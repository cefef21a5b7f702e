#include "lowlap/averaging/internal/imprecise_views.h"

#include <algorithm>
#include <optional>
#include <utility>

#include "lowlap/averaging/internal/view_grades.h"
#include "lowlap/scene/internal/center_stddev.h"

namespace lowlap {
namespace {

// The square root of x with P(chi^2_3 > x) = 0.05.
const double kDeviationsOfRegion = 2.7955;

}  // namespace

std::vector<ReliabilityWarning> FindImpreciseViews(const Scene& scene,
                                                   const PoseSummary& summary) {
  std::vector<std::pair<ViewId, const Pose*>> firm;
  for (const auto& [view, graded] : GradeViews(summary)) {
    if (graded.grade != ViewGrade::kFirm) continue;
    if (const Pose* pose = scene.FindPose(view)) firm.emplace_back(view, pose);
  }
  if (firm.size() < 3) return {};
  double size = 0;
  for (const auto& [view, pose] : firm) {
    for (const auto& [other, of_other] : firm) {
      size = std::max(size, (pose->center - of_other->center).norm());
    }
  }
  std::vector<ReliabilityWarning> warnings;
  for (const auto& [view, pose] : firm) {
    const std::optional<double> stddev = CenterStddev(*pose);
    if (!stddev) continue;
    const double reach = *stddev * kDeviationsOfRegion;
    if (reach <= kFirmReach * size) continue;
    ReliabilityWarning warning;
    warning.reason = WarningReason::kImprecise;
    warning.views = {view};
    warning.share = reach / size;
    warnings.push_back(std::move(warning));
  }
  return warnings;
}

}  // namespace lowlap
