#pragma once

#include <cstdint>
#include <vector>

#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/study/internal/robustness/scenarios.h"

namespace lowlap {

/// What every strategy gets in a robustness study, and the truth beside it.
struct SimulatedProblem {
  TranslationProblem problem;
  std::vector<Vec3> true_centers;  // of problem.views, in the true world
  /// Rotation from the world of the problem into the true one.
  Mat3 truth_from_solved = Mat3::Identity();
};

/// Simulates the level with that seed: scene, rotations, ratios, problem.
/// Errors: those of AverageSceneRotations and EstimateScaleRatios.
Result<SimulatedProblem> SimulateProblem(const RobustnessLevel& level,
                                         std::uint64_t seed,
                                         const RunContext& context);

}  // namespace lowlap
