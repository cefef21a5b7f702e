#pragma once

#include <string>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/adjustment_summary.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

struct SolveRequest {
  std::string stage;
  bool fixed_rotations = false;
  double function_tolerance = 1e-8;
  NoiseLevels noise;
};

struct SolveOutcome {
  SolveReport report;
  std::size_t components = 0;
  std::vector<char> pose_observed;  // by index: has residuals
};

/// One run of the solver over the candidates in use (SelectForSolve). Changes
/// poses, intrinsics and landmarks. Errors: kInsufficientData (nothing to
/// solve), kNumerical, kCancelled; the state is then of no use.
Result<SolveOutcome> SolveOnce(const AdjustmentOptions& options,
                               const SolveRequest& request,
                               const RunContext& context, CameraSet* cameras,
                               StructureState* state);

}  // namespace lowlap
