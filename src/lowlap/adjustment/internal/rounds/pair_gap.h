#pragma once

#include <limits>
#include <vector>

#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

/// How far two lines are from meeting, as each is estimated from its own
/// segments, whatever it was adjusted to. With the common normal n, P_a = p_a +
/// s d_a and P_b the closest points, the gap n . (P_b - P_a) changes by
///   d gap = n . (dP_b - dP_a),  dP_a = B_a (a + s b)
/// to first order (B, a, b as in LineNormalEquations), which gives its standard
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

}  // namespace lowlap
