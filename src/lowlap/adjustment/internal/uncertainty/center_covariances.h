#pragma once

#include <map>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

/// What the observations leave open of the camera centres. Of components of at
/// least three poses.
struct CenterUncertainty {
  /// Covariances in world units, without the gauge (CovariancesWithoutGauge).
  std::map<PoseId, Mat3> covariances;
  /// Of log(|c3 - c2| / |c2 - c1|), in which no gauge has a part.
  std::map<ViewTriplet, double> log_ratio_stddevs;
  /// Of the direction of c2 - c1 as the best observed camera would see it,
  /// along the axis in which it is known least.
  std::map<ViewPair, double> direction_stddevs_rad;
};

/// From the adjusted state, with all but the cameras marginalised
/// (LinearisedProblem): S is J^T J with the weighted and robustified residuals,
/// so that the noise levels are in it. Every deviation is the larger of that of
/// independent noise, and of what the gradients show (ScatterOfGradients). What
/// nothing determines gets one beyond all others.
///
/// Relative poses and scale ratios, which hold the adjustment as priors, are
/// left out: what they know they have from the same features.
///
/// Deviations of ratios and directions are those of the triplets and pairs
/// asked for whose centres are in one component.
CenterUncertainty EstimateCenterUncertainty(
    const AdjustmentOptions& options, const NoiseLevels& noise,
    const std::vector<ViewTriplet>& triplets,
    const std::vector<ViewPair>& pairs, CameraSet cameras,
    StructureState state);

}  // namespace lowlap
