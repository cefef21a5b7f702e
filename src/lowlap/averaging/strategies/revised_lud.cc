#include "lowlap/averaging/strategies/internal/revised_lud.h"

#include <algorithm>
#include <cmath>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/strategies/internal/direction_system.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {

Status RevisedLudOptions::Validate() const {
  if (max_iterations > 0) return {};
  return MakeError(ErrorCode::kInvalidArgument,
                   "the number of iterations must be positive");
}

Result<std::vector<Vec3>> SolveRevisedLud(const DirectionPart& part,
                                          const RevisedLudOptions& options,
                                          const RunContext& context,
                                          int* num_iterations) {
  constexpr double kLeastDelta = 1e-6;  // of the mean length
  constexpr double kDamping = 1e-12;
  constexpr double kDecrease = 1e-12;
  const double num_edges = static_cast<double>(part.edges.size());
  std::vector<Vec3> pulls(part.views.size(), Vec3::Zero());
  for (const DirectionEdge& edge : part.edges) {
    pulls[edge.second] += edge.direction_in_world;
    pulls[edge.first] -= edge.direction_in_world;
  }
  DirectionSystem system(part);
  std::vector<Vec3> centers;
  std::vector<Mat3> weights(part.edges.size());
  double delta = HUGE_VAL;  // the first round is least squares
  double last_cost = HUGE_VAL;
  for (int iteration = 0; iteration < options.max_iterations; ++iteration) {
    LOWLAP_RETURN_IF_ERROR(
        AskToGoOn(context, iteration, options.max_iterations));
    for (std::size_t e = 0; e < part.edges.size(); ++e) {
      const DirectionEdge& edge = part.edges[e];
      const Vec3& d = edge.direction_in_world;
      const Mat3 across = Mat3::Identity() - d * d.transpose();
      double weight = 1;
      if (!centers.empty()) {
        const Vec3 residual =
            across * (centers[edge.second] - centers[edge.first]);
        weight = 1 / std::sqrt(residual.squaredNorm() + delta * delta);
      }
      weights[e] = weight * across;
    }
    // H C = lambda a, a^T C = number of edges.
    LOWLAP_RETURN_IF_ERROR(system.Factor(weights, kDamping));
    LOWLAP_ASSIGN_OR_RETURN(auto solved, system.Solve(pulls));
    double reach = 0;
    for (std::size_t v = 0; v < pulls.size(); ++v) {
      reach += pulls[v].dot(solved[v]);
    }
    if (!(reach > 0)) {
      return MakeError(ErrorCode::kNumerical,
                       "the directions of a part cancel out");
    }
    for (Vec3& center : solved) center *= num_edges / reach;
    centers = std::move(solved);
    ++*num_iterations;

    delta = std::isinf(delta) ? 1.0 : std::max(delta / 2, kLeastDelta);
    double cost = 0;
    for (const DirectionEdge& edge : part.edges) {
      const Vec3 offset = centers[edge.second] - centers[edge.first];
      cost += edge.direction_in_world.cross(offset).norm();
    }
    if (delta == kLeastDelta &&
        std::abs(last_cost - cost) <= kDecrease * (cost + num_edges)) {
      break;
    }
    last_cost = cost;
  }
  return centers;
}

}  // namespace lowlap
