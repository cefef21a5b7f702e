#pragma once

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// The soft-L1 translations of OpenMVG (Moulon, Monasse, Perrot, Marlet,
/// "OpenMVG: Open multiple view geometry", 2016), on pairwise directions:
///
///   min over C, s  sum 2 b^2 (sqrt(1 + r_ij^2 / b^2) - 1),
///   r_ij = |C_j - C_i - s_ij d_ij|,   s_ij >= 1,   b = 0.01.
///
/// Least squares for residuals below b, absolute values above; lengths are in
/// units of the shortest edge. Convex. Ratios and deviations are ignored; only
/// parallel-rigid parts of three or more views are placed
/// (SolveDirectionParts), each in a component of its own.
class SoftL1Averager : public TranslationAverager {
 public:
  std::string Name() const override { return "soft_l1"; }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;
};

}  // namespace lowlap
