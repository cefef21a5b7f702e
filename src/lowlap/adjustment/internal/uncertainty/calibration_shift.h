#pragma once

#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/adjustment_summary.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"
#include "lowlap/adjustment/internal/uncertainty/center_covariances.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// A calibration that is off moves the cameras all the same: adds to
/// `uncertainty` how far. From the adjusted state the same observations are
/// solved once with what the images prefer where they contradict it
/// (CalibrationPreference), and elsewhere with focal lengths that are off as
/// far as they could be (FocalFactorsAtStake). Where that leads is added
/// (CenterShift): it tells how much is at stake rather than where to, since
/// what is preferred is as uncertain.
///
/// Nothing is added where nothing is preferred, or the solve fails. Errors:
/// kCancelled.
Status AddCalibrationShift(
    const AdjustmentOptions& options, const NoiseLevels& noise,
    const std::vector<CalibrationPreference>& preferences, const Scene& scene,
    const RunContext& context, const CameraSet& cameras, StructureState state,
    CenterUncertainty* uncertainty);

}  // namespace lowlap
