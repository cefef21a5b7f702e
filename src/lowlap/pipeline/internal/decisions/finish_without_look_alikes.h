#pragma once

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// SolveScene from the composed poses on (DecideHypothesesByStructure,
/// FinishSolution), without the relative poses that join places that look
/// alike.
///
/// Those are found in the finished solution (FindLookAlikes), since only there
/// the structure tells what a view should see. The scene is solved again from
/// the composed start, as if their pairs had been compared in vain: what they
/// outnumbered may hold the views together then. That is taken, and looked at
/// again, if fewer pairs are of groups that see different things at one place
/// (LookAlikes::different), and if no views are lost but those that were
/// doubtful for it; else all stays as it was, and doubtful. Where none is
/// found, nothing more is done.
///
/// `scene` holds the poses of `composed`; it gets poses, ratios and structure
/// of the result, whose outliers name what was left out (kLookAlike). Errors:
/// those of the first solution, DecideHypothesesByStructure and FinishSolution;
/// kCancelled.
Result<SolveResult> FinishWithoutLookAlikes(ComposedSolution composed,
                                            const SolveOptions& options,
                                            const RunContext& context,
                                            StageLog* stages, Scene* scene);

}  // namespace lowlap
