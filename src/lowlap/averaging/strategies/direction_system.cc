#include "lowlap/averaging/strategies/internal/direction_system.h"

#include <algorithm>

namespace lowlap {

DirectionSystem::DirectionSystem(const DirectionPart& part) : part_(part) {}

Status DirectionSystem::Factor(const std::vector<Mat3>& weights,
                               double damping) {
  const auto size = 3 * (static_cast<Eigen::Index>(part_.views.size()) - 1);
  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(27 * part_.edges.size() + static_cast<std::size_t>(size));
  double trace = 0;
  // Explicit zeros keep the pattern.
  const auto add = [&](std::size_t a, std::size_t b, const Mat3& block) {
    if (a == 0 || b == 0) return;
    const int row = 3 * (static_cast<int>(a) - 1);
    const int column = 3 * (static_cast<int>(b) - 1);
    if (a == b) trace += block.trace();
    for (int r = 0; r < 3; ++r) {
      for (int c = 0; c < 3; ++c) {
        if (row + r >= column + c) {
          entries.emplace_back(row + r, column + c, block(r, c));
        }
      }
    }
  };
  for (std::size_t e = 0; e < part_.edges.size(); ++e) {
    const DirectionEdge& edge = part_.edges[e];
    add(edge.first, edge.first, weights[e]);
    add(edge.second, edge.second, weights[e]);
    add(std::max(edge.first, edge.second), std::min(edge.first, edge.second),
        -weights[e]);
  }
  const double shift = damping * trace / static_cast<double>(size);
  for (int row = 0; row < size; ++row) entries.emplace_back(row, row, shift);
  hessian_.resize(size, size);
  hessian_.setFromTriplets(entries.begin(), entries.end());
  if (!is_analysed_) {
    solver_.analyzePattern(hessian_);
    is_analysed_ = true;
  }
  solver_.factorize(hessian_);
  if (solver_.info() != Eigen::Success) {
    return MakeError(ErrorCode::kNumerical,
                     "the system of directions could not be factored");
  }
  return {};
}

Result<std::vector<Vec3>> DirectionSystem::Solve(
    const std::vector<Vec3>& forces) const {
  const auto count = static_cast<Eigen::Index>(part_.views.size());
  Eigen::VectorXd rhs(3 * (count - 1));
  for (Eigen::Index v = 1; v < count; ++v) {
    rhs.segment<3>(3 * (v - 1)) = forces[static_cast<std::size_t>(v)];
  }
  const Eigen::VectorXd solution = solver_.solve(rhs);
  if (solver_.info() != Eigen::Success || !solution.allFinite()) {
    return MakeError(ErrorCode::kNumerical,
                     "the system of directions could not be solved");
  }
  std::vector<Vec3> centers(part_.views.size(), Vec3::Zero());
  for (Eigen::Index v = 1; v < count; ++v) {
    centers[static_cast<std::size_t>(v)] = solution.segment<3>(3 * (v - 1));
  }
  return centers;
}

}  // namespace lowlap
