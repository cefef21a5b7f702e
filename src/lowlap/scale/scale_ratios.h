#pragma once

#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scale/scale_estimator.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/scene/scale_ratio.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The ratios of the triplets, in their order, including those that are not
/// meaningful or have no candidates (see their verdict). Kinds of evidence of
/// EvidenceRound::kUndecided are asked in a second test of those that are not
/// meaningful without. Triplets with a view without an intrinsic or features
/// have no candidates; nor have those at which the estimator fails, of which a
/// warning tells. The same for any number of threads.
///
/// Where copies of a pattern that repeats were taken for each other along the
/// epipolar lines, as windows along a wall, the relative poses are right and
/// what was matched so is at wrong depths: it agrees on a ratio of its own, and
/// may be most of what was matched. So meaningful ratios of triplets in which
/// something of that kind was matched (ViewFeatures::repeated_points) are
/// tested again, in the same rounds, without it. If that says another ratio, by
/// more than six deviations, with log10 NFA < -3, that is the ratio, and the
/// first its second mode. If nothing meaningful is left, the ratio is not
/// meaningful whatever copies say for it, and its log10 NFA is what is left.
///
/// Errors: those of MakeTripletView, kCancelled.
Result<std::vector<ScaleRatio>> EstimateScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const ScaleEstimator& estimator, const RunContext& context);

/// The same with the estimator that the options name, of the given triplets or
/// of all (FindTriplets of scene/view_graph.h). Errors: invalid options too.
Result<std::vector<ScaleRatio>> EstimateScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const ScaleOptions& options, const RunContext& context);
Result<std::vector<ScaleRatio>> EstimateScaleRatios(const Scene& scene,
                                                    const ScaleOptions& options,
                                                    const RunContext& context);

}  // namespace lowlap
