#include "lowlap/adjustment/internal/costs/direction_cost.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include "lowlap/adjustment/internal/costs/jacobian_map.h"
#include "lowlap/adjustment/internal/costs/quaternion.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {

DirectionCost::DirectionCost(const Vec3& direction_in_cam,
                             const Mat3& covariance) {
  const auto basis = TangentBasis(direction_in_cam);
  const Mat2 information = (basis.transpose() * covariance * basis).inverse();
  weight_ = information.llt().matrixU() * basis.transpose();
}

bool DirectionCost::Evaluate(const double* const* parameters, double* residuals,
                             double** jacobians) const {
  const QuaternionRotation rotation(parameters[0]);
  const Eigen::Map<const Vec3> direction(parameters[1]);
  const Mat3 matrix = rotation.Matrix();
  Eigen::Map<Vec2>(residuals, 2) = weight_ * matrix * direction;
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) {
    JacobianMap<2, 4>(jacobians[0]) = weight_ * rotation.Jacobian(direction);
  }
  if (jacobians[1] != nullptr) {
    JacobianMap<2, 3>(jacobians[1]) = weight_ * matrix;
  }
  return true;
}

}  // namespace lowlap
