#pragma once

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// Constrained least squares on directions (Tron & Vidal, "Distributed
/// image-based 3-D localization of camera sensor networks", CDC 2009):
///
///   min over C, s  sum |C_j - C_i - s_ij d_ij|^2,   s_ij >= 1.
///
/// The bound keeps the centres from collapsing. Convex, so the start does not
/// matter; not robust: one wrong direction bends everything near it, and long
/// edges weigh more than short ones. Unweighted, as published. Ratios are
/// ignored; only parallel-rigid parts of three or more views are placed
/// (SolveDirectionParts), each in a component of its own.
class L2ChordalAverager : public TranslationAverager {
 public:
  std::string Name() const override { return "l2_chordal"; }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;
};

}  // namespace lowlap
