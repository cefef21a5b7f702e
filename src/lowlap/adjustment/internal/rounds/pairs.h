#pragma once

#include <ceres/cost_function.h>

#include <cstddef>
#include <limits>
#include <memory>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

/// One residual of a coplanar pair: a view, and the indices of the line that
/// the meeting point is taken on and of the line it is compared with.
struct PairTerm {
  int view = -1;
  int on = -1;
  int to = -1;
};

/// The residuals of a pair, one kind or the other. kTransfer: for every view of
/// each line; kImageDistance: for every view of both (none if no view sees
/// both).
std::vector<PairTerm> PairTerms(const StructureState& state,
                                const PairState& pair,
                                AdjustedCoplanarResidual residual);

std::unique_ptr<ceres::CostFunction> MakePairCost(
    const CameraSet& cameras, const PairTerm& term,
    AdjustedCoplanarResidual residual);

/// Root mean square of the pair's residuals, in pixels; infinity without any.
double PairErrorPx(const CameraSet& cameras, const StructureState& state,
                   const PairState& pair, AdjustedCoplanarResidual residual);

/// How far two lines are from meeting, as each is estimated from its own
/// segments, whatever it was adjusted to. With the common normal n, P_a = p_a +
/// s d_a and P_b the closest points, the gap n . (P_b - P_a) changes by
///   d gap = n . (dP_b - dP_a),  dP_a = B_a (a + s b)
/// to first order (B, a, b as in LineEstimate), which gives its standard
/// deviation at 1 px of noise of the segments.
struct PairGap {
  /// The gap over that deviation: how many pixels of noise explain it. The same
  /// whatever way the plane faces.
  double gap_px = std::numeric_limits<double>::infinity();
  /// That deviation, in world units: how well the pair can be judged.
  double unit_stddev = std::numeric_limits<double>::infinity();
};

PairGap ComputePairGap(const LineEstimate& a, const LineEstimate& b);

/// Of every pair; infinite where a line is no landmark or not determined.
std::vector<PairGap> ComputePairGaps(const CameraSet& cameras,
                                     const StructureState& state);

/// Noise of the pairs from their gaps; at least that of lines, so that no pair
/// is believed more than a segment.
NoiseScale EstimatePairNoise(const CameraSet& cameras,
                             const std::vector<PairGap>& gaps,
                             const NoiseScale& line_noise,
                             const NoiseBounds& bounds);

/// Decides which pairs have residuals in the next solve, and returns for how
/// many that changed.
///
/// A pair in use was free to bend its lines within their noise: it stays if its
/// residual is within the threshold, and else is inconsistent. One out of use
/// is consistent if noise explains its gap (PairGap) and, if `take_new`, is
/// taken into use, those that can be judged best first, while both of its lines
/// have less than max_pairs_per_line pairs. Only pairs with a line of two views
/// are taken: where both lines are determined by three, they say what the lines
/// say themselves, and cost the solver's matrix its sparsity.
std::size_t SelectPairs(const AdjustmentOptions& options,
                        const CameraSet& cameras, double threshold_px,
                        bool take_new, StructureState* state);

}  // namespace lowlap
