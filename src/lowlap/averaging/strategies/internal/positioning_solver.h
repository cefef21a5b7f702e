#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

struct PositioningOptions {
  double huber_reach = 0.1;
  int max_iterations = 200;
};

/// The unknowns of global positioning.
struct PositioningState {
  std::vector<Vec3> centers;
  std::vector<Vec3> points;                 // one per track
  std::vector<std::vector<double>> scales;  // one per observation
};

/// sum over tracks k, observations i of rho(|ray_ik - s_ik (X_k - C_i)|^2),
/// rho(q) = q up to q = reach^2, 2 reach sqrt(q) - reach^2 beyond.
double PositioningCost(const std::vector<TrackRays>& tracks,
                       const PositioningState& state, double huber_reach);

/// Levenberg-Marquardt from `state`; the scales stay above 1e-6. Every step
/// eliminates the scales, then the points, and solves for the centres. The
/// gauge (translation and scale) is left to the damping. Returns the number of
/// iterations; kCancelled if the host stops it; kNumerical if no step can be
/// computed.
Result<int> SolvePositions(const std::vector<TrackRays>& tracks,
                           const PositioningOptions& options,
                           const RunContext& context, PositioningState* state);

}  // namespace lowlap
