#pragma once

#include <vector>

#include "lowlap/averaging/strategies/internal/direction_parts.h"
#include "lowlap/core/result.h"

namespace lowlap {

/// The convex programs on directions with lengths of at least one:
///
///   min over C, s  sum_e phi(|C_j - C_i - s_e d_e|),   s_e >= 1,
///   phi(r) = width^2 (sqrt(1 + (r / width)^2) - 1).
///
/// An infinite width is least squares, phi = r^2 / 2; as the width goes to 0,
/// phi / width goes to r. Lengths are unitless: the shortest is 1.
///
/// s_e = max(1, d_e . (C_j - C_i)) is eliminated, which leaves a convex
/// function of C with a continuous gradient. It is minimised by Newton's method
/// on the current set of bounded lengths with the weights phi'(r) / r
/// (reweighted least squares), and a line search; sparse LDL^T. `centers` is
/// the start (empty: all lengths are 1) and the result; its first view is at
/// the origin. Stops where the objective decreases by less than 1e-13 of
/// itself. Returns the iterations; kNumerical if a factorisation fails;
/// kCancelled.
Result<int> MinimiseBounded(const DirectionPart& part, double width,
                            int max_iterations, const RunContext& context,
                            std::vector<Vec3>* centers);

/// MinimiseBounded from least squares over tenfold narrower losses down to
/// `width`: narrow losses converge slowly from far away. `max_iterations` are
/// those of the last one. Adds to `num_iterations`.
Result<std::vector<Vec3>> MinimiseNarrowing(const DirectionPart& part,
                                            double width, int max_iterations,
                                            const RunContext& context,
                                            int* num_iterations);

/// The objective of MinimiseBounded.
double BoundedObjective(const DirectionPart& part, double width,
                        const std::vector<Vec3>& centers);

}  // namespace lowlap
