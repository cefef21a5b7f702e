#pragma once

#include <optional>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scale/internal/search/ratio_sweep.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/scale_ratio.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// NFA(tau) of a triplet: what its features say about every ratio, not the best
/// one alone.
struct RatioProfile {
  /// The NFA on a grid of log ratios: even over the range of the features' own
  /// ratios, and finer and finer towards the mode. Sorted; empty without
  /// candidates.
  std::vector<RatioOptimum> nodes;
  /// The least NFA of all ratios (SweepRatios).
  RatioOptimum mode;
  /// The next best ratio that is not on a flank of the mode: between the two
  /// log10 NFA rises above it by a tenth of the mode's, and by 1 at least (on
  /// the grid). How much worse it is, second_mode->nfa.log10_nfa -
  /// mode.nfa.log10_nfa, says how sure the choice is. None if there is none.
  std::optional<RatioOptimum> second_mode;
  /// The estimate with its interval and shares of information: the mode refined
  /// on its inliers. Its own second mode is only looked for where it is cheap.
  ScaleRatio ratio;
};

/// For TestTriplets.
inline ScaleRatio& RatioOf(RatioProfile& profile) { return profile.ratio; }
void PayForSecondTest(RatioProfile* profile);

/// The profile of one triplet, by the calibrated a-contrario criterion,
/// whatever `options` says about the form, criterion and search.
///
/// Errors: those of ScaleEstimator::Estimate.
Result<RatioProfile> ProfileRatio(const TripletView& triplet,
                                  const ScaleOptions& options);

/// The profiles of many triplets, in their order. Points on planes
/// (use_coplanar_points) take part exactly where EstimateScaleRatios asks them:
/// in a second test of the triplets that are not meaningful without, which adds
/// log10 2 to every total. Errors as in EstimateScaleRatios.
Result<std::vector<RatioProfile>> ProfileScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const ScaleOptions& options, const RunContext& context);

}  // namespace lowlap
