#pragma once

#include <array>
#include <optional>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scale/ratio_sweep.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/scale_ratio.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// NFA(tau) of a triplet: what its features say about every ratio, not the best
/// one alone.
struct RatioProfile {
  ViewTriplet views;
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
  /// Refined on the inliers; holds the true log ratio with a probability of
  /// 95 % if the mode is right: log_ratio +- 1.96 standard deviations, those of
  /// the relative poses included.
  double log_ratio = 0;
  double interval_low = 0;
  double interval_high = 0;
  /// Shares of the information (the curvature of the log likelihood in
  /// log tau) by kind, in the order of FeatureKind; they add up to 1, or are 0
  /// without inliers.
  std::array<double, kFeatureKinds.size()> information_share{};
};

/// The profile of one triplet, by the calibrated a-contrario criterion,
/// whatever `options` says about the form, criterion and search.
///
/// Errors: those of ScaleEstimator::Estimate.
Result<RatioProfile> ProfileRatio(const TripletView& triplet,
                                  const ScaleOptions& options);

/// The profiles of many triplets, in their order; points on planes
/// (use_coplanar_points) are left out. Errors as in EstimateScaleRatios.
Result<std::vector<RatioProfile>> ProfileScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const ScaleOptions& options, const RunContext& context);

}  // namespace lowlap
