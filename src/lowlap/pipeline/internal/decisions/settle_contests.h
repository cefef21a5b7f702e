#pragma once

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Asks third views about relative poses that contradict the solution and
/// contest a part of it (PoseSummary::contests), and composes the poses again
/// with what they say.
///
/// A relative pose that joins two places that look alike explains the matches
/// of its two views as well as a right one does. But a right one sees what its
/// neighbours see: with a relative pose of one side of the contested cut it
/// shares points, lines or planes that agree on a scale ratio. So what counts
/// of its evidence is at most that of the best such ratio, if that is not weak
/// (IsWeak), of the links of the weakest cut as of those that contradict them.
/// The contest is found again, or not, with what is left
/// (ThirdViewVerdicts::evidence). If the contradictions have more than twice
/// what the links have, these are left out instead
/// (ThirdViewVerdicts::outweighed), unless that loses a view. There, weak
/// contradictions (RelativePose::weakness) count nothing, and weak links as
/// what has no evidence.
///
/// scene->scale_ratios, scene->poses, and rotations, ratios and poses of
/// `composed` become those of the new solution. Without a contest nothing is
/// done. Errors: those of EstimateBelievedRatios and ComposePoses.
Status SettleContests(const SolveOptions& options, const RunContext& context,
                      StageLog* stages, Scene* scene,
                      ComposedSolution* composed);

}  // namespace lowlap
