#pragma once

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

struct RevisedLudOptions {
  int max_iterations = 200;

  Status Validate() const;
  template <class Visit>
  void VisitOptions(const Visit& visit) {
    visit("max_iterations", &max_iterations, "at most so many iterations");
  }
};

/// Revised LUD (Zhuang, Cheong, Lee, "Baseline desensitizing in translation
/// averaging", CVPR 2018): LUD with one linear constraint on the scale in place
/// of a bound on every length, which frees it from the shortest baseline:
///
///   min over C, s  sum |C_j - C_i - s_ij d_ij|,
///   sum (C_j - C_i) . d_ij = number of edges.
///
/// s_ij = (C_j - C_i) . d_ij of either sign is eliminated. Convex; iteratively
/// reweighted least squares. It is also where BATA starts. Ratios and
/// deviations are ignored; only parallel-rigid parts of three or more views are
/// placed (SolveDirectionParts), each in a component of its own.
class RevisedLudAverager : public TranslationAverager {
 public:
  explicit RevisedLudAverager(RevisedLudOptions options = {})
      : options_(options) {}
  std::string Name() const override { return "revised_lud"; }
  Result<TranslationSolution> Solve(const TranslationProblem& problem,
                                    const RunContext& context) const override;

 private:
  RevisedLudOptions options_;
};

}  // namespace lowlap
