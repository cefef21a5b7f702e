#pragma once

#include <map>
#include <utility>
#include <vector>

#include "lowlap/core/run_context.h"
#include "lowlap/scale/internal/planes/planes.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// The planes of a relative pose as `middle` sees them: those of FindPlanes on
/// its point and line inliers, pieces of a broken segment one by one. Empty if
/// the pose, or the features of a view, are missing.
PairPlanes PlanesOfPair(const Scene& scene,
                        const NormalizedFeaturesByView& features, ViewId middle,
                        ViewId neighbor);

/// False if the features that the two pairs match lie in disjoint parts of the
/// middle view (as their bounding boxes tell): no plane of one pair then
/// extends to a feature of the other, and there are no plane points. The views
/// must have normalised features.
bool PairsOverlap(const Scene& scene, const NormalizedFeaturesByView& features,
                  const ViewTriplet& views);

/// The planes of all pairs that the triplets need, each found once; in
/// parallel. Errors: kCancelled.
Result<PlanesByPair> FindPlanesByPair(const Scene& scene,
                                      const NormalizedFeaturesByView& features,
                                      const std::vector<ViewTriplet>& triplets,
                                      const RunContext& context);

}  // namespace lowlap
