#include "lowlap/adjustment/internal/costs/coplanar_costs.h"

#include <Eigen/Geometry>

#include "lowlap/adjustment/internal/costs/jacobian_map.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

using Row3 = Eigen::RowVector3d;
using ByLines = Eigen::Matrix<double, 3, 12>;
using ConstVec = Eigen::Map<const Vec3>;

// d (v / |v|) = (I - u u^T) dv / |v|, u = v / |v|.
Mat3 NormalizedJacobian(const Vec3& unit, double length) {
  return (Mat3::Identity() - unit * unit.transpose()) / length;
}

// Into the solver's blocks.
template <int Rows>
void Store(const Eigen::Matrix<double, Rows, 3>& by_center,
           const Eigen::Matrix<double, Rows, 12>& by_lines,
           double** jacobians) {
  if (jacobians[0] != nullptr) JacobianMap<Rows, 3>(jacobians[0]) = by_center;
  for (int line = 0; line < 2; ++line) {
    if (jacobians[1 + line] == nullptr) continue;
    JacobianMap<Rows, 6>(jacobians[1 + line]) =
        by_lines.template middleCols<6>(6 * line);
  }
}

}  // namespace

Vec3 ClosestPoint(const double* on, const double* to, ByLines* jacobian) {
  const ConstVec p_on(on), d_on(on + 3), p_to(to), d_to(to + 3);
  const Vec3 n = d_on.cross(d_to), between = p_to - p_on;
  const Vec3 moment = between.cross(d_to);
  const double n2 = n.squaredNorm() + 1e-24;
  const double along = moment.dot(n) / n2;
  if (jacobian != nullptr) {
    const Vec3 by_between = d_to.cross(n) / n2;
    const Vec3 by_n = (moment - 2 * along * n) / n2;
    Eigen::Matrix<double, 1, 12> by_lines;
    by_lines << -by_between.transpose(), d_to.cross(by_n).transpose(),
        by_between.transpose(),
        (n.cross(between) / n2 + by_n.cross(d_on)).transpose();
    *jacobian = d_on * by_lines;
    jacobian->leftCols<3>() += Mat3::Identity();
    jacobian->middleCols<3>(3) += along * Mat3::Identity();
  }
  return p_on + along * d_on;
}

bool CoplanarTransferCost::Evaluate(const double* const* parameters,
                                    double* residuals,
                                    double** jacobians) const {
  const ConstVec center(parameters[0]), p_b(parameters[2]),
      d_b(parameters[2] + 3);
  ByLines closest;
  const Vec3 ray = ClosestPoint(parameters[1], parameters[2],
                                jacobians != nullptr ? &closest : nullptr) -
                   center;
  const Vec3 arm = p_b - center;
  const Vec3 normal = arm.cross(d_b);
  const double ray_length = ray.norm(), normal_length = normal.norm();
  residuals[0] = scale_px_ * ray.dot(normal) / (ray_length * normal_length);
  if (jacobians == nullptr) return true;
  const Vec3 unit_ray = ray / ray_length, unit_normal = normal / normal_length;
  const Row3 by_ray = scale_px_ * unit_normal.transpose() *
                      NormalizedJacobian(unit_ray, ray_length);
  const Row3 by_normal = scale_px_ * unit_ray.transpose() *
                         NormalizedJacobian(unit_normal, normal_length);
  const Row3 by_arm = -by_normal * CrossMatrix(d_b);
  Eigen::Matrix<double, 1, 12> by_lines = by_ray * closest;
  by_lines.segment<3>(6) += by_arm;
  by_lines.tail<3>() += by_normal * CrossMatrix(arm);
  Store<1>(-by_ray - by_arm, by_lines, jacobians);
  return true;
}

bool CoplanarImageDistanceCost::Evaluate(const double* const* parameters,
                                         double* residuals,
                                         double** jacobians) const {
  const ConstVec center(parameters[0]);
  ByLines closest_a, closest_b;
  const bool with_jacobians = jacobians != nullptr;
  const Vec3 ray_a = ClosestPoint(parameters[1], parameters[2],
                                  with_jacobians ? &closest_a : nullptr) -
                     center;
  const Vec3 ray_b = ClosestPoint(parameters[2], parameters[1],
                                  with_jacobians ? &closest_b : nullptr) -
                     center;
  const double length_a = ray_a.norm(), length_b = ray_b.norm();
  const Vec3 unit_a = ray_a / length_a, unit_b = ray_b / length_b;
  Eigen::Map<Vec3> residual(residuals);
  residual = scale_px_ * (unit_a - unit_b);
  if (!with_jacobians) return true;
  const Mat3 by_a = scale_px_ * NormalizedJacobian(unit_a, length_a);
  const Mat3 by_b = -scale_px_ * NormalizedJacobian(unit_b, length_b);
  ByLines by_lines = by_a * closest_a;
  by_lines.leftCols<6>() += by_b * closest_b.rightCols<6>();
  by_lines.rightCols<6>() += by_b * closest_b.leftCols<6>();
  Store<3>(-by_a - by_b, by_lines, jacobians);
  return true;
}

}  // namespace lowlap
