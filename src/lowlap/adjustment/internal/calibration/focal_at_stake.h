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
/// c^2 / Var c, c^2 (1 - 1 / t). It is there long before the images contradict
/// what is held (t > 9). The estimate is of first order, and is not followed
/// beyond half the focal length.
///
/// Points and lines are asked. Where lines are ill determined their score has a
/// mean (FindCalibrationPreferences), and what is at stake is overstated.
std::vector<double> FocalFactorsAtStake(const AdjustmentOptions& options,
                                        const NoiseLevels& noise,
                                        const Scene& scene,
                                        const CameraSet& cameras,
                                        const StructureState& state);

}  // namespace lowlap
