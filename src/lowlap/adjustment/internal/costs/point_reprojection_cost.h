#pragma once

#include <ceres/cost_function.h>

#include "lowlap/adjustment/internal/costs/jacobian_map.h"
#include "lowlap/adjustment/internal/costs/projection.h"
#include "lowlap/adjustment/internal/costs/quaternion.h"

namespace lowlap::internal {

/// The error of a point that is behind its camera, in place of a projection
/// that means nothing; the loss then treats the observation as an outlier.
inline constexpr double kBehindCameraErrorPx = 1e4;

/// r = W (project(M(q) (X - C)) - observed), in raw pixels (2), with W the
/// whitening of the observation.
///
/// Parameter blocks: rotation q (4), centre C (3), point X (3) and, if the
/// intrinsic is refined, its parameters (4 + number of coefficients). Analytic
/// chain; the projection itself by dual numbers.
class PointReprojectionCost final : public ceres::CostFunction {
 public:
  /// `intrinsic` must outlive the cost; its parameters are used where the
  /// intrinsic is not a block.
  PointReprojectionCost(const IntrinsicState* intrinsic, bool refine_intrinsic,
                        const Vec2& observed_px,
                        const Mat2& whitening = Mat2::Identity())
      : intrinsic_(intrinsic),
        observed_px_(observed_px),
        whitening_(whitening) {
    set_num_residuals(2);
    *mutable_parameter_block_sizes() = {4, 3, 3};
    if (refine_intrinsic) {
      mutable_parameter_block_sizes()->push_back(intrinsic->ParameterCount());
    }
  }

  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override {
    const QuaternionRotation rotation(parameters[0]);
    const Eigen::Map<const Vec3> center(parameters[1]), point(parameters[2]);
    const Vec3 ray = point - center;
    const Mat3 matrix = rotation.Matrix();
    const Vec3 x_cam = matrix * ray;
    const bool refined = parameter_block_sizes().size() == 4;
    Eigen::Map<Vec2> residual(residuals);
    Mat23 by_x_cam = Mat23::Zero();
    Eigen::Matrix<double, 2, kMaxIntrinsicParameters> by_intrinsic;
    by_intrinsic.setZero();
    if (!IsProjectable(intrinsic_->value.model, x_cam)) {
      residual.setConstant(kBehindCameraErrorPx);
    } else {
      Vec2 pixel_px;
      if (jacobians == nullptr) {
        ProjectPoint(intrinsic_->value,
                     refined ? parameters[3] : intrinsic_->parameters.data(),
                     x_cam.data(), pixel_px.data());
      } else if (refined) {
        pixel_px = Project(parameters[3], x_cam, &by_x_cam, &by_intrinsic);
      } else {
        pixel_px = *ProjectWithJacobian(*intrinsic_, x_cam, &by_x_cam);
      }
      Vec2 difference_px = pixel_px - observed_px_;
      WrapPanorama(intrinsic_->value, &difference_px);
      residual = whitening_ * difference_px;
      by_x_cam = (whitening_ * by_x_cam).eval();
      by_intrinsic = (whitening_ * by_intrinsic).eval();
    }
    if (jacobians == nullptr) return true;
    if (jacobians[0] != nullptr) {
      JacobianMap<2, 4>(jacobians[0]) = by_x_cam * rotation.Jacobian(ray);
    }
    const Mat23 by_point = by_x_cam * matrix;
    if (jacobians[1] != nullptr) JacobianMap<2, 3>(jacobians[1]) = -by_point;
    if (jacobians[2] != nullptr) JacobianMap<2, 3>(jacobians[2]) = by_point;
    if (refined && jacobians[3] != nullptr) {
      const int count = intrinsic_->ParameterCount();
      JacobianMap<2>(jacobians[3], count) = by_intrinsic.leftCols(count);
    }
    return true;
  }

 private:
  Vec2 Project(
      const double* parameters, const Vec3& x_cam, Mat23* by_x_cam,
      Eigen::Matrix<double, 2, kMaxIntrinsicParameters>* by_intrinsic) const {
    using Jet = ceres::Jet<double, 3 + kMaxIntrinsicParameters>;
    std::array<Jet, kMaxIntrinsicParameters> intrinsic;
    for (int n = 0; n < intrinsic_->ParameterCount(); ++n) {
      intrinsic[n] = Jet(parameters[n], 3 + n);
    }
    const Jet x[3] = {Jet(x_cam.x(), 0), Jet(x_cam.y(), 1), Jet(x_cam.z(), 2)};
    Jet pixel[2];
    ProjectPoint(intrinsic_->value, intrinsic.data(), x, pixel);
    for (int row = 0; row < 2; ++row) {
      by_x_cam->row(row) = pixel[row].v.head<3>().transpose();
      by_intrinsic->row(row) =
          pixel[row].v.tail<kMaxIntrinsicParameters>().transpose();
    }
    return {pixel[0].a, pixel[1].a};
  }

  const IntrinsicState* intrinsic_;
  Vec2 observed_px_;
  Mat2 whitening_;
};

}  // namespace lowlap::internal
