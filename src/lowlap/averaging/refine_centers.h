#pragma once

#include <vector>

#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/result.h"

namespace lowlap {

/// Joint robust refinement of camera centres on directions and ratios:
///   min sum_e rho(|u_e - d_e| / sigma_e)
///     + sum_r rho((log L_target - log L_reference - log tau) / sigma_r),
///   u = (C_second - C_first) / L,  L = |C_second - C_first|.
/// Levenberg-Marquardt with Geman-McClure weights; the gauge (translation and
/// scale) stays where the start has it. Only edges and ratios whose views are
/// all marked in `placed` take part.
Status RefineCenters(const TranslationProblem& problem,
                     const std::vector<bool>& placed,
                     std::vector<Vec3>* centers, int max_iterations = 50);

}  // namespace lowlap
