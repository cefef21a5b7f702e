#pragma once

#include <vector>

#include "lowlap/averaging/strategies/internal/direction_parts.h"
#include "lowlap/core/result.h"

namespace lowlap {

struct BataOptions {
  /// Each sets the weights, then descends by `steps_per_round`.
  int rounds = 10;
  int steps_per_round = 10;

  Status Validate() const;
  template <class Visit>
  void VisitOptions(const Visit& visit) {
    visit("rounds", &rounds, "how often the robust weights are set");
    visit("steps_per_round", &steps_per_round, "steps of descent for each");
  }
};

/// Bilinear angle-based translation averaging (Zhuang, Cheong, Lee, "Baseline
/// desensitizing in translation averaging", CVPR 2018):
///
///   min over C, q  sum rho(|q_ij (C_j - C_i) - d_ij|),   q_ij >= 0,
///
/// where q is an inverse length, so that a residual at its best q is the sine
/// of the angle between C_j - C_i and d_ij (1 beyond a right angle), whatever
/// the baseline. rho is Huber's with the turn at 0.1. As published: the start
/// is revised LUD; in ten rounds the weights are set, and in each, ten times, q
/// in closed form and C by linear least squares (block coordinate descent).
/// The paper's further weights from rotations are left out: rotations are
/// averaged, and their outliers removed, before.
///
/// Not convex: a start that is wrong may stay wrong. Adds to `num_iterations`;
/// kNumerical if an equation cannot be solved; kCancelled.
Result<std::vector<Vec3>> SolveBata(const DirectionPart& part,
                                    const BataOptions& options,
                                    const RunContext& context,
                                    int* num_iterations);

/// The turn of Huber's loss, a sine: that of the published program.
inline constexpr double kAngleHuber = 0.1;

}  // namespace lowlap
