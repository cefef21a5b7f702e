#pragma once

#include <array>
#include <cstddef>
#include <optional>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/adjustment_summary.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

/// Of points, lines and coplanar pairs, as KindAdjustment has them.
using KindRmse = std::array<std::optional<double>, 3>;

/// Of the candidates in use whose error is finite.
KindRmse ComputeRmse(const CameraSet& cameras, const StructureState& state,
                     AdjustedCoplanarResidual residual);

/// Adds landmarks and observations, in use and dropped, to the summary.
void CountObservations(const std::vector<PointTrackState>& points,
                       KindAdjustment* summary);
void CountObservations(const std::vector<LineTrackState>& lines,
                       KindAdjustment* summary);

/// The same of pairs; `input_pairs` of them were given.
void CountPairs(const std::vector<PairState>& pairs, std::size_t input_pairs,
                KindAdjustment* summary);

}  // namespace lowlap
