#pragma once

#include <vector>

#include "lowlap/averaging/strategies/internal/direction_parts.h"
#include "lowlap/core/result.h"

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
/// reweighted least squares. View 0 is at the origin. It is also where BATA
/// starts. Adds to `num_iterations`; kNumerical if a factorisation fails;
/// kCancelled.
Result<std::vector<Vec3>> SolveRevisedLud(const DirectionPart& part,
                                          const RevisedLudOptions& options,
                                          const RunContext& context,
                                          int* num_iterations);

}  // namespace lowlap
