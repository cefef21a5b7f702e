#pragma once

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/adjustment/internal/structure_state.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap::internal {

/// Noise of every kind from the present residuals of all candidates.
NoiseLevels EstimateAllNoise(const CameraSet& cameras,
                             const StructureState& state,
                             const AdjustmentOptions& options);

struct ObservationChanges {
  std::size_t changed = 0;  // candidates and pairs whose use changed
  std::size_t total = 0;
};

/// Decides anew which candidates are in use: those within the threshold of
/// their kind at the present landmarks. A landmark that not all candidates fit
/// is also triangulated afresh, and so is a track without one; what more
/// candidates fit is taken. Lines that the solver leaves out (SelectForSolve)
/// always follow the poses. Pairs are in use within their threshold.
Result<ObservationChanges> UpdateObservations(const AdjustmentOptions& options,
                                              const NoiseLevels& noise,
                                              const RunContext& context,
                                              const CameraSet& cameras,
                                              StructureState* state);

}  // namespace lowlap::internal
