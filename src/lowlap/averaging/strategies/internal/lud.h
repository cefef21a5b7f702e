#pragma once

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// Least unsquared deviations (Ozyesil & Singer, "Robust camera location
/// estimation by convex programming", CVPR 2015):
///
///   min over C, s  sum |C_j - C_i - s_ij d_ij|,   s_ij >= 1,
///
/// by iteratively reweighted least squares with the weight
/// 1 / sqrt(r^2 + delta^2), delta going down to 1e-6 of the shortest edge.
/// Convex; exact in spite of some wrong directions if the others are exact.
/// Ratios and deviations are ignored; only parallel-rigid parts of three or
/// more views are placed (SolveDirectionParts), each in a component of its own.
class LudAverager : public TranslationAverager {
 public:
  std::string Name() const override { return "lud"; }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;
};

}  // namespace lowlap
