#pragma once

#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scale/evidence/evidence_kind.h"
#include "lowlap/scale/internal/criterion/ratio_nfa.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/scale_ratio.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// NFA(tau) of a triplet: what its candidates say about every ratio, not the
/// best one alone.
struct RatioProfile {
  /// The names of RatioNfa::kinds.
  std::vector<std::string> kinds;
  /// The NFA on a grid of log ratios: even over the range of the candidates'
  /// own ratios, and finer and finer towards the mode. Sorted; empty without
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

/// The profile of one triplet, by the calibrated a-contrario criterion.
///
/// Errors: those of ScaleEstimator::Estimate.
Result<RatioProfile> ProfileRatio(const TripletView& triplet,
                                  const TripletEvidence& evidence);

/// The profiles of many triplets, in their order. Every kind takes part exactly
/// where EstimateScaleRatios asks it; what repeats counts like the rest. Errors
/// as there.
Result<std::vector<RatioProfile>> ProfileScaleRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    const EvidenceKinds& kinds, const RunContext& context);

/// For a drawing of ratios that were estimated from these kinds: only `nodes`,
/// on a coarser grid, and nothing is searched. What it costs is to gather the
/// evidence. In the order of the ratios, which are `ratio`; those without
/// candidates have no nodes. Errors as there.
Result<std::vector<RatioProfile>> SketchScaleRatios(
    const Scene& scene, const std::vector<ScaleRatio>& ratios,
    const EvidenceKinds& kinds, const RunContext& context);

}  // namespace lowlap
