#pragma once

#include <Eigen/SparseCholesky>
#include <vector>

#include "lowlap/averaging/strategies/internal/direction_parts.h"
#include "lowlap/core/result.h"

namespace lowlap {

/// The normal equations of a part with one 3x3 weight per edge,
///   H = sum_e A_e^T W_e A_e,   A_e C = C_second - C_first,
/// in the gauge where view 0 is at the origin. The pattern is analysed once.
class DirectionSystem {
 public:
  explicit DirectionSystem(const DirectionPart& part);

  /// Factors H + damping mean(diag H) I; kNumerical if that fails.
  Status Factor(const std::vector<Mat3>& weights, double damping);
  /// Solves for all centres; the force on view 0 is ignored.
  Result<std::vector<Vec3>> Solve(const std::vector<Vec3>& forces) const;

 private:
  const DirectionPart& part_;
  Eigen::SparseMatrix<double> hessian_;
  Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver_;
  bool is_analysed_ = false;
};

}  // namespace lowlap
