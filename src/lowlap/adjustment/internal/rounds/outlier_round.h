#pragma once

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// Triangulates anew what the solver leaves out (SelectForSolve): tracks of
/// kinds that are not used, and lines of two views without a pair. They follow
/// the poses and have no say. `line_noise` is that of the lines that are used.
Status FollowPoses(const AdjustmentOptions& options,
                   const NoiseScale& line_noise, const RunContext& context,
                   const CameraSet& cameras, StructureState* state);

/// Noise of every kind from the present residuals of all candidates.
NoiseLevels EstimateAllNoise(const CameraSet& cameras,
                             const StructureState& state,
                             const AdjustmentOptions& options);

struct ObservationChanges {
  std::size_t changed = 0;  // candidates and pairs whose use changed
  std::size_t total = 0;

  double Share() const {
    return total > 0 ? static_cast<double>(changed) / static_cast<double>(total)
                     : 0.0;
  }
};

struct ObservationUpdate {
  bool take_new_pairs = false;
  /// Of tracks with more than two candidates: how many times the threshold an
  /// error may be.
  double gate = 1;
};

/// Decides anew which candidates of the used kinds are in use: those within the
/// threshold of their kind at the present landmarks. A landmark that not all
/// candidates fit is also triangulated afresh, and so is a track without one;
/// what more candidates fit is taken. Then the pairs (SelectPairs).
Result<ObservationChanges> UpdateObservations(const AdjustmentOptions& options,
                                              const NoiseLevels& noise,
                                              const ObservationUpdate& update,
                                              const RunContext& context,
                                              const CameraSet& cameras,
                                              StructureState* state);

}  // namespace lowlap
