#pragma once

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The scene with the relative poses and ratios that SolveScene would use and
/// that agree with what it solves, without the others; ratios that it holds
/// are taken as they are. What hangs together in it hangs on nothing that is
/// left out later. A scene without relative poses comes back as it is. Errors:
/// those of StartSolution, EstimateBelievedRatios and ComposePoses.
Result<Scene> SceneInUse(Scene scene, SolveOptions options,
                         const RunContext& context);

}  // namespace lowlap
