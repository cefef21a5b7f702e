#pragma once

#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/adjustment_summary.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

/// Which held parts of the calibration the images contradict, at an adjusted
/// state: a score test of every part. With the gradient g and the Hessian H of
/// the cost of points, by the held parameters t and, x, everything
/// that is free (poses, landmarks, refined parts),
///   u = g_t - H_tx H_xx^-1 g_x,   I = H_tt - H_tx H_xx^-1 H_xt,
/// the calibration that the images prefer is away by -I^-1 u, and u^T I^-1 u
/// has a chi-square distribution if only noise is in u. So has u^T V^-1 u, with
/// V from the landmarks' own shares of u, whatever the noise level; the lesser
/// of the two counts. Parts are taken in one after the other, the least
/// probable first, each given those before it, as long as noise explains one
/// with a probability below 1 % over all that are tested.
///
/// One intrinsic at a time, or, beyond 16, all by one common change (of the
/// focal lengths and the aspect by a factor, of the principal points by a share
/// of the diagonal); the first of the preference is one that points observe.
/// Pinholes are tested for a k1.
///
/// Points alone are asked; without them nothing is said. The score of lines has
/// a mean: on simulated rooms with the true calibration, of 1.7 standard
/// deviations in the aspect, where that of points has -0.1. Coplanar pairs and
/// relative poses depend on both.
std::vector<CalibrationPreference> FindCalibrationPreferences(
    const AdjustmentOptions& options, const NoiseLevels& noise,
    CameraSet cameras, StructureState state);

}  // namespace lowlap
