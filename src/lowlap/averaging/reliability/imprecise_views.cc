#include "lowlap/averaging/reliability/internal/imprecise_views.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include "lowlap/averaging/reliability/internal/view_grades.h"
#include "lowlap/robust/internal/chi_square.h"
#include "lowlap/scene/internal/center_stddev.h"

namespace lowlap {
namespace {

constexpr int kDimension = 3;
const double kLogChance = std::log(0.05);

bool MayBeOffByMore(double stddev, double bound) {
  const double deviations = bound / stddev;
  return LogChiSquareTail(deviations * deviations, kDimension) > kLogChance;
}

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
    if (!stddev || !MayBeOffByMore(*stddev, kFirmReach * size)) continue;
    ReliabilityWarning warning;
    warning.reason = WarningReason::kImprecise;
    warning.views = {view};
    warning.share = *stddev / size;
    warnings.push_back(std::move(warning));
  }
  return warnings;
}

}  // namespace lowlap
