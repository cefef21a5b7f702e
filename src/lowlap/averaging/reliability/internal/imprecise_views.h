#pragma once

#include <vector>

#include "lowlap/averaging/reliability_warning.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// WarningReason::kImprecise: placed views that no other warning names, whose
/// centre may be further off than kFirmReach of the scene's size: its 95 %
/// region reaches further along the axis in which it is known least,
///   P(chi^2_3 > (kFirmReach size / CenterStddev)^2) > 0.05.
/// The size is the greatest distance of two such views; what is doubted for
/// another reason may be anywhere. Views without a covariance have no entry,
/// nor has a scene of fewer than three such views, in which the size is chosen.
/// One entry per view, by views.
std::vector<ReliabilityWarning> FindImpreciseViews(const Scene& scene,
                                                   const PoseSummary& summary);

}  // namespace lowlap
