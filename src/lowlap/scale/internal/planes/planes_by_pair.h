#pragma once

#include <map>
#include <utility>
#include <vector>

#include "lowlap/core/run_context.h"
#include "lowlap/scale/internal/planes/planes.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// By middle view and neighbour.
using PlanesByPair = std::map<std::pair<ViewId, ViewId>, PairPlanes>;

/// False if the features that the two pairs match lie in disjoint parts of the
/// middle view (as their bounding boxes tell): no plane of one pair then
/// extends to a feature of the other. The views must have normalised features.
bool PairsOverlap(const SceneFeatures& features, const ViewTriplet& views);

/// The planes of all relative poses that the triplets need, as the middle view
/// sees them, each found once (FindPlanes on its point and line inliers, pieces
/// of a fragmented segment one by one); in parallel. None where the pose, or
/// the features of a view, are missing. Errors: kCancelled.
Result<PlanesByPair> FindPlanesByPair(const SceneFeatures& features,
                                      const std::vector<ViewTriplet>& triplets,
                                      const RunContext& context);

}  // namespace lowlap
