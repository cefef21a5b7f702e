#pragma once

#include <map>
#include <vector>

#include "lowlap/averaging/scene_poses.h"
#include "lowlap/merge/merge_models.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Every relative pose of `relative_poses` between two views that have a pose,
/// in different places, against these poses.
std::vector<PairAgreement> ComparePairs(
    const std::map<ViewPair, RelativePose>& relative_poses,
    const std::map<ViewId, Pose>& poses, const PoseOptions& options);

/// Every meaningful ratio between views that have a pose, likewise.
std::vector<RatioAgreement> CompareRatios(const std::vector<ScaleRatio>& ratios,
                                          const std::map<ViewId, Pose>& poses,
                                          const PoseOptions& options);

/// log of the length of (middle, last) over that of (first, middle); all three
/// must have a pose, and no two of them in one place.
double LogRatioOf(const std::map<ViewId, Pose>& poses,
                  const ViewTriplet& views);

}  // namespace lowlap
