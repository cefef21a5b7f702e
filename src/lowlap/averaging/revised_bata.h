#pragma once

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// The objective of BATA (BataAverager: Zhuang, Cheong, Lee 2018; Huber's loss
/// of the sine of the angle between C_j - C_i and d_ij), minimised over centres
/// and inverse lengths jointly, as global mappers do (Pan, Barath, Pollefeys,
/// Schonberger, "Global structure-from-motion revisited", ECCV 2024, on
/// directions between cameras), and not by block coordinate descent of a fixed
/// number of rounds: the inverse lengths are eliminated, and
/// Levenberg-Marquardt runs until the objective stands still. The start is
/// revised LUD.
///
/// Not convex: a start that is wrong may stay wrong. Ratios and deviations are
/// ignored; only parallel-rigid parts of three or more views are placed
/// (SolveDirectionParts), each in a component of its own.
class RevisedBataAverager : public TranslationAverager {
 public:
  std::string Name() const override { return "revised_bata"; }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;
};

}  // namespace lowlap
