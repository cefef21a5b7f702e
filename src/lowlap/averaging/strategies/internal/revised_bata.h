#pragma once

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

struct RevisedBataOptions {
  int max_iterations = 200;

  Status Validate() const;
  template <class Visit>
  void VisitOptions(const Visit& visit) {
    visit("max_iterations", &max_iterations, "at most so many iterations");
  }
};

/// The objective of BATA (BataAverager: Zhuang, Cheong, Lee 2018; Huber's loss
/// of the sine of the angle between C_j - C_i and d_ij) at its minimum: the
/// inverse lengths are eliminated, and Levenberg-Marquardt runs over the
/// centres until the objective stands still, instead of a hundred steps of
/// block coordinate descent. This is how global mappers minimise it (Pan,
/// Barath, Pollefeys, Schonberger, "Global structure-from-motion revisited",
/// ECCV 2024, on directions between cameras). The start is revised LUD.
///
/// It is not the rotation-assisted variant of the paper, which weighs an edge
/// down also where its relative rotation disagrees with the averaged ones: no
/// relative rotation is part of a TranslationProblem, and edges that disagree
/// are left out before. A lower objective is not always a smaller error: within
/// 6 degrees the loss is quadratic in the angle, so that the minimum follows
/// short baselines, whose directions are the least certain, as much as long
/// ones, while descent that stops early stays closer to revised LUD, which does
/// not. Where such edges matter, BataAverager comes out better.
///
/// Not convex: a start that is wrong may stay wrong. Ratios and deviations are
/// ignored; only parallel-rigid parts of three or more views are placed
/// (SolveDirectionParts), each in a component of its own.
class RevisedBataAverager : public TranslationAverager {
 public:
  explicit RevisedBataAverager(RevisedBataOptions options = {})
      : options_(options) {}
  std::string Name() const override { return "revised_bata"; }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;

 private:
  RevisedBataOptions options_;
};

}  // namespace lowlap
