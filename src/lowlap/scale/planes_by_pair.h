#pragma once

#include <map>
#include <utility>
#include <vector>

#include "lowlap/core/run_context.h"
#include "lowlap/scale/planes.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// The planes of a relative pose as `middle` sees them: those of FindPlanes on
/// its point and line inliers, pieces of a broken segment one by one. Empty if
/// the pose, or the features of a view, are missing.
PairPlanes PlanesOfPair(const Scene& scene,
                        const NormalizedFeaturesByView& features, ViewId middle,
                        ViewId neighbor);

/// The same for all pairs that the triplets need, each found once; in parallel.
/// Errors: kCancelled.
Result<PlanesByPair> FindPlanesByPair(const Scene& scene,
                                      const NormalizedFeaturesByView& features,
                                      const std::vector<ViewTriplet>& triplets,
                                      const RunContext& context);

}  // namespace lowlap
