#pragma once

#include "lowlap/averaging/rotations/scene_rotations.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Rotations, ratios and poses again, with other verdicts about the relative
/// poses; ratios that the scene has are those of its relative poses. Errors:
/// those of AverageSceneRotations, EstimateBelievedRatios and ComposePoses.
Result<ComposedSolution> ComposeAgain(const MatchVerdicts& matches,
                                      ThirdViewVerdicts verdicts,
                                      SolveOptions options,
                                      const RunContext& context,
                                      StageLog* stages, Scene* scene);

}  // namespace lowlap
