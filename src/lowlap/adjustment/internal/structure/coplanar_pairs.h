#pragma once

#include <map>
#include <vector>

#include "lowlap/adjustment/bundle_adjuster.h"

namespace lowlap {

/// The coplanar inliers of the meaningful ratios as pairs of line landmarks:
/// each line is the one that holds the inlier's segment of the middle view.
/// Unique and ordered; counts what is left out in `summary`.
std::vector<CoplanarPair> CollectCoplanarPairs(
    const std::vector<ScaleRatio>& ratios,
    const std::map<LineTrackId, LineLandmark>& lines, double min_angle_rad,
    StructureSummary* summary);

}  // namespace lowlap
