#pragma once

#include <ceres/sized_cost_function.h>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// How far a direction D of the scene is from where a camera sees it, in
/// standard deviations (2):
///   r = W B^T R D,  B = TangentBasis(d),  W^T W = (B^T C B)^-1,
/// d the direction in the camera, of either sign, and C its covariance.
/// Parameter blocks: the camera's rotation (x y z w), D (unit). Blind to a turn
/// of 180 degrees.
class DirectionCost final : public ceres::SizedCostFunction<2, 4, 3> {
 public:
  DirectionCost(const Vec3& direction_in_cam, const Mat3& covariance);
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::Matrix<double, 2, 3> weight_;  // W B^T
};

}  // namespace lowlap
