#pragma once

#include <ceres/problem.h>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// Ceres' Levenberg-Marquardt with a sparse factorisation, until an iteration
/// lowers the sum by less than `tolerance` of it; returns their number. On one
/// thread, and so the same for any number of them. Where no step can be
/// computed, or none lowers the sum, the parameters stay as they are.
/// kCancelled, with the parameters of the last iteration.
Result<int> Minimise(const RunContext& context, int max_iterations,
                     double tolerance, ceres::Problem* problem);

}  // namespace lowlap
