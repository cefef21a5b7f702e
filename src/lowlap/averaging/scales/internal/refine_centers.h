#pragma once

#include <vector>

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// Joint robust refinement of camera centres on directions and ratios:
///   min sum_e rho(|u_e - d_e| / sigma_e)
///     + sum_r rho((log L_target - log L_reference - log tau) / sigma_r),
///   u = (C_second - C_first) / L,  L = |C_second - C_first|.
/// Levenberg-Marquardt with Geman and McClure's loss; the gauge
/// (translation and scale) stays where the start has it. Only edges and ratios
/// whose views are all marked in `placed` take part; the two edges of a
/// ratio share one view.
///
/// sigma is the stated deviation times a factor for each of the two kinds, at
/// least 1, which the median residual of the start asks for (MAD; Huber, Robust
/// Statistics, 1981). Stated deviations do not cover what errors share; with
/// them alone the bounded loss can gain by giving up all directions of a view
/// to please its ratios, which say little across a plane of centres. The factor
/// is not estimated again: it would shrink with what is given up.
///
/// Where no step can be computed, or none lowers the sum, the centres stay as
/// they are. kCancelled, with the centres as they were.
Status RefineCenters(const TranslationProblem& problem,
                     const std::vector<bool>& placed,
                     std::vector<Vec3>* centers, const RunContext& context = {},
                     int max_iterations = 50);

}  // namespace lowlap
