#pragma once

#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

/// By how much the held focal lengths could be off, by intrinsic: factors; 1 of
/// those that are refined, that images do not determine, or that noise explains
/// to within a standard deviation.
///
/// What the images prefer (CalibrationScore, each focal length by itself) is
/// away by c, of which noise has a share. As in the moments of a random effect,
/// the square of what remains is c^2 - Var c, or, with the statistic t =
/// c^2 / Var c, c^2 (1 - 1 / t). It is short of a contradiction, which asks for
/// t > 9: errors of that size are what moves cameras most where points are few.
/// The estimate is of first order, and is not followed beyond half the focal
/// length.
///
/// Points and lines are asked. Their score has a mean where lines are ill
/// determined (up to some per cent of the focal length on walls seen from far
/// away), and what is at stake is overstated there.
std::vector<double> FocalFactorsAtStake(const AdjustmentOptions& options,
                                        const NoiseLevels& noise,
                                        const Scene& scene,
                                        const CameraSet& cameras,
                                        const StructureState& state);

}  // namespace lowlap
