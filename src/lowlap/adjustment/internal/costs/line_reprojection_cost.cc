#include "lowlap/adjustment/internal/costs/line_reprojection_cost.h"

#include <optional>

#include "lowlap/adjustment/internal/costs/jacobian_map.h"
#include "lowlap/adjustment/internal/costs/quaternion.h"

namespace lowlap {
namespace {

using EndsJacobian = Eigen::Matrix<double, 2, 3>;

}  // namespace

LineReprojectionCost::LineReprojectionCost(const SegmentRays& segment,
                                           double weight,
                                           const IntrinsicState& intrinsic,
                                           bool refine_intrinsic)
    : segment_(segment),
      weight_(weight),
      intrinsic_count_(refine_intrinsic ? intrinsic.ParameterCount() : 0),
      linearised_at_(intrinsic.parameters) {
  set_num_residuals(2);
  *mutable_parameter_block_sizes() = {4, 3, 6};
  if (refine_intrinsic) {
    mutable_parameter_block_sizes()->push_back(intrinsic_count_);
  }
}

bool LineReprojectionCost::Evaluate(const double* const* parameters,
                                    double* residuals,
                                    double** jacobians) const {
  const QuaternionRotation rotation(parameters[0]);
  const Eigen::Map<const Vec3> center(parameters[1]), point(parameters[2]),
      direction(parameters[2] + 3);
  const Vec3 arm = point - center;
  const Vec3 moment = arm.cross(direction);  // of the line about the centre
  const Mat3 matrix = rotation.Matrix();
  const Vec3 normal = matrix * moment;

  std::optional<SegmentRays> moved;
  if (intrinsic_count_ > 0) {
    moved = segment_;
    for (EndPointRay& end : moved->ends) {
      for (int n = 0; n < intrinsic_count_; ++n) {
        end.ray +=
            end.by_intrinsic.col(n) * (parameters[3][n] - linearised_at_[n]);
      }
    }
  }
  const SegmentRays& segment = moved ? *moved : segment_;
  EndsJacobian by_normal;
  for (int n = 0; n < 2; ++n) {
    Eigen::RowVector3d row;
    residuals[n] =
        weight_ * EndPointDistancePx(segment.ends[n], normal,
                                     jacobians != nullptr ? &row : nullptr);
    if (jacobians != nullptr) by_normal.row(n) = weight_ * row;
  }
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) {
    JacobianMap<2, 4>(jacobians[0]) = by_normal * rotation.Jacobian(moment);
  }
  const EndsJacobian by_moment = by_normal * matrix;
  const EndsJacobian by_center = by_moment * CrossMatrix(direction);
  if (jacobians[1] != nullptr) {
    JacobianMap<2, 3>(jacobians[1]) = by_center;
  }
  if (jacobians[2] != nullptr) {
    auto by_line = JacobianMap<2, 6>(jacobians[2]);
    by_line.leftCols<3>() = -by_center;
    by_line.rightCols<3>() = by_moment * CrossMatrix(arm);
  }
  if (intrinsic_count_ > 0 && jacobians[3] != nullptr) {
    auto by_intrinsic = JacobianMap<2>(jacobians[3], intrinsic_count_);
    for (int n = 0; n < 2; ++n) {
      const EndPointRay& end = segment.ends[n];
      const double length = (end.by_pixel.transpose() * normal).norm();
      const Vec3 by_ray = length > 0 ? Vec3(normal / length) : Vec3::Zero();
      by_intrinsic.row(n) = weight_ * by_ray.transpose() *
                            end.by_intrinsic.leftCols(intrinsic_count_);
    }
  }
  return true;
}

}  // namespace lowlap
