#pragma once

#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/internal/structure_state.h"

namespace lowlap::internal {

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

/// Root mean square of the pair's residuals, in pixels; infinity without any.
double PairErrorPx(const CameraSet& cameras, const StructureState& state,
                   const PairState& pair, AdjustedCoplanarResidual residual);

/// How much noise of the segments, in pixels, explains that two lines do not
/// meet: the gap between the lines as each is estimated from its own segments,
/// over the standard deviation of the gap at 1 px of noise. With the common
/// normal n, P_a = p_a + s d_a and P_b the closest points, to first order
///   d gap = n . (dP_b - dP_a),  dP_a = B_a (a + s b).
/// It neither depends on what the pair was adjusted to, nor on the way the
/// plane faces. Infinity for the lines of which one is not determined.
double PairGapPx(const LineEstimate& a, const LineEstimate& b);

/// PairGapPx of every pair; infinity where a line is no landmark.
std::vector<double> PairGapsPx(const CameraSet& cameras,
                               const StructureState& state);

/// Noise of the pairs from these gaps; at least that of lines, so that no pair
/// is believed more than a segment.
NoiseScale EstimatePairNoise(const CameraSet& cameras,
                             const std::vector<double>& gaps_px,
                             const NoiseScale& line_noise,
                             const NoiseBounds& bounds);

}  // namespace lowlap::internal
