#pragma once

#include <map>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Ratios and poses under rotations that a host has found, one for every view:
/// scene->poses get them as they are.
///
/// A relative pose that contradicts them, by the rule of AverageSceneRotations,
/// is left out; relative poses are taken to have one motion each. Errors, with
/// the scene in an intermediate state: those of the ratios and of
/// SolveScenePoses.
Result<PoseSummary> SolveGivenRotations(
    const std::map<ViewId, Mat3>& cam_from_world, const SolveOptions& options,
    const RunContext& context, StageLog* stages, Scene* scene);

}  // namespace lowlap
