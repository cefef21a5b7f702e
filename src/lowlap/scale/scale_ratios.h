#pragma once

#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/scene/scale_ratio.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The ratio of every triplet of the scene, in the order of FindTriplets
/// (scene/view_graph.h), including those that are not meaningful or have no
/// candidates (see their verdict). Triplets that are not meaningful by points,
/// lines and pairs are tested a second time with plane points
/// (ScaleOptions::use_coplanar_points). Triplets with a view without an
/// intrinsic or features have no candidates. The same for any number of
/// threads.
///
/// Errors: invalid options, those of MakeTripletView, kCancelled.
Result<std::vector<ScaleRatio>> EstimateScaleRatios(const Scene& scene,
                                                    const ScaleOptions& options,
                                                    const RunContext& context);

/// The same for the given triplets only, in their order.
Result<std::vector<ScaleRatio>> EstimateScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const ScaleOptions& options, const RunContext& context);

}  // namespace lowlap
