#pragma once

#include <vector>

#include "lowlap/averaging/strategies/internal/direction_parts.h"
#include "lowlap/core/result.h"

namespace lowlap {

/// min over C  sum |P_e (C_j - C_i)|,  P_e = I - d_e d_e^T, subject to
/// sum d_e . (C_j - C_i) = number of edges: the revised LUD of Zhuang, Cheong,
/// Lee 2018, by reweighted least squares. View 0 is at the origin. Adds to
/// `num_iterations`; kNumerical if a factorisation fails;
/// kCancelled.
Result<std::vector<Vec3>> SolveRevisedLud(const DirectionPart& part,
                                          int max_iterations,
                                          const RunContext& context,
                                          int* num_iterations);

/// sum rho(e) over the edges, e the sine of the angle between C_j - C_i and d_e
/// up to a right angle, 1 beyond it and for coincident centres; rho Huber's
/// loss, e^2 / 2 up to kAngleHuber.
double AngleObjective(const DirectionPart& part,
                      const std::vector<Vec3>& centers);

/// The turn of Huber's loss, a sine: that of the published program.
inline constexpr double kAngleHuber = 0.1;

}  // namespace lowlap
