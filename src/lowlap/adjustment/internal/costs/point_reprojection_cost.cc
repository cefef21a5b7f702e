#include "lowlap/adjustment/internal/costs/point_reprojection_cost.h"

#include "lowlap/adjustment/internal/costs/jacobian_map.h"
#include "lowlap/adjustment/internal/costs/projection.h"
#include "lowlap/adjustment/internal/costs/quaternion.h"

namespace lowlap {

PointReprojectionCost::PointReprojectionCost(const IntrinsicState* intrinsic,
                                             bool refine_intrinsic,
                                             const Vec2& observed_px,
                                             const Mat2& whitening)
    : intrinsic_(intrinsic), observed_px_(observed_px), whitening_(whitening) {
  set_num_residuals(2);
  *mutable_parameter_block_sizes() = {4, 3, 3};
  if (refine_intrinsic) {
    mutable_parameter_block_sizes()->push_back(intrinsic->ParameterCount());
  }
}

bool PointReprojectionCost::Evaluate(const double* const* parameters,
                                     double* residuals,
                                     double** jacobians) const {
  const QuaternionRotation rotation(parameters[0]);
  const Eigen::Map<const Vec3> center(parameters[1]), point(parameters[2]);
  const Vec3 ray = point - center;
  const Mat3 matrix = rotation.Matrix();
  const Vec3 x_cam = matrix * ray;
  const bool refined = parameter_block_sizes().size() == 4;
  const Intrinsic& shape = intrinsic_->value;
  const double* values =
      refined ? parameters[3] : intrinsic_->parameters.data();
  Eigen::Map<Vec2> residual(residuals);
  Mat23 by_x_cam;
  Eigen::Matrix<double, 2, kMaxIntrinsicParameters> by_intrinsic;
  if (!IsProjectable(shape.model, x_cam)) {
    residual.setConstant(kBehindCameraErrorPx);
    by_x_cam.setZero();
    by_intrinsic.setZero();
  } else {
    Vec2 difference_px =
        (jacobians == nullptr ? ProjectPoint(shape, values, x_cam)
         : refined
             ? ProjectPoint(shape, values, x_cam, &by_x_cam, &by_intrinsic)
             : ProjectPoint(shape, values, x_cam, &by_x_cam)) -
        observed_px_;
    WrapPanorama(shape, &difference_px);
    residual = whitening_ * difference_px;
  }
  if (jacobians == nullptr) return true;
  by_x_cam = (whitening_ * by_x_cam).eval();
  if (jacobians[0] != nullptr) {
    JacobianMap<2, 4>(jacobians[0]) = by_x_cam * rotation.Jacobian(ray);
  }
  const Mat23 by_point = by_x_cam * matrix;
  if (jacobians[1] != nullptr) JacobianMap<2, 3>(jacobians[1]) = -by_point;
  if (jacobians[2] != nullptr) JacobianMap<2, 3>(jacobians[2]) = by_point;
  if (refined && jacobians[3] != nullptr) {
    const int count = intrinsic_->ParameterCount();
    JacobianMap<2>(jacobians[3], count) =
        (whitening_ * by_intrinsic).leftCols(count);
  }
  return true;
}

}  // namespace lowlap
