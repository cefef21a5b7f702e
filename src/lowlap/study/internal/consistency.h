#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/scene/scene.h"
#include "lowlap/study/compare_strategies.h"

namespace lowlap {

/// Judges scene.poses and scene.structure by the relative poses (but for
/// `outliers`) and the scale ratios between views with a pose. Pairs whose
/// solved centres coincide count with 90 degrees; ratios of such pairs are left
/// out, like observations behind their camera.
Consistency EvaluateConsistency(const Scene& scene,
                                const std::vector<ViewPair>& outliers);

}  // namespace lowlap
