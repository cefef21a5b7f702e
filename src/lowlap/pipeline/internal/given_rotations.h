#pragma once

#include <map>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Ratios and poses under rotations that a host has found: scene->poses get
/// them as they are; views without one are not placed.
///
/// Of the motions of a relative pose the one that is closest to the rotations
/// is taken. A relative pose that contradicts them, by the rule of
/// AverageSceneRotations, is left out. Errors, with the scene in an
/// intermediate state: those of the ratios and of SolveScenePoses.
Result<PoseSummary> SolveGivenRotations(
    const std::map<ViewId, Mat3>& cam_from_world, const SolveOptions& options,
    const RunContext& context, StageLog* stages, Scene* scene);

}  // namespace lowlap
