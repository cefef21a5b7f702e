#pragma once

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Decides between the motions of pairs that neither cycles nor triplets tell
/// apart (DecideHypotheses) by what the whole scene shows.
///
/// The scene is composed and adjusted with another motion of one pair, and with
/// the present ones (RunMotionTrials). What that leaves unexplained of what
/// more than two views see is the cost: no relative pose has chosen these
/// tracks. It decides if the others cost more by 46, ten decimal digits of
/// likelihood, and by a tenth, since errors have much in common (where loops
/// are loose, false motions were seen ahead by a twentieth). The change that
/// explains most is made first, and so on; where nothing decides, the pose and
/// its alternatives stay.
///
/// Of pairs that are in use, and at most eight: those whose motions differ
/// most. Nothing is asked where `options` do not adjust.
///
/// `scene` holds the poses of ComposePoses from `rotations`, whose verdicts
/// hold in the trials, and `result` its summary, the ratios and the decisions
/// so far; all follow, and the log says what became of every decision. The
/// result does not depend on the number of threads. Error: kCancelled.
Status DecideHypothesesByStructure(const SceneRotations& rotations,
                                   const SolveOptions& options,
                                   const RunContext& context, StageLog* stages,
                                   Scene* scene, SolveResult* result);

}  // namespace lowlap
