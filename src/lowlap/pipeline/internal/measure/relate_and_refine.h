#pragma once

#include <functional>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/internal/measure/pair_report.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// A solution of which the refined intrinsics are wanted.
struct FirstSolution {
  SolveOptions solve;
  IntrinsicRefinement refinement;  // nothing: there is none
};

/// Estimates a scene's relative poses and tracks, with the intrinsics that it
/// has; what was estimated before is replaced.
using RelateViews = std::function<Result<std::vector<PairReport>>(Scene*)>;

/// Relative poses from a wrong focal length are wrong themselves: if a first
/// solution moves the intrinsics by more than a pixel, views are related once
/// more with the refined ones, which are then the scene's: what is measured
/// with them is only right with them. A first solution that fails changes
/// nothing, with a warning. Errors: those of `relate`; kCancelled.
Result<std::vector<PairReport>> RelateAndRefine(const RelateViews& relate,
                                                const FirstSolution& first,
                                                const RunContext& context,
                                                StageLog* stages, Scene* scene);

}  // namespace lowlap
