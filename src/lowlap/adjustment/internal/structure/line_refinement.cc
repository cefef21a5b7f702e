#include "lowlap/adjustment/internal/structure/line_refinement.h"

#include <Eigen/Dense>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {

double LineNormalEquations(const std::vector<LineMeasurement>& measurements,
                           const Vec3& point, const Vec3& direction,
                           Eigen::Matrix4d* hessian, Vec4* gradient) {
  hessian->setZero();
  if (gradient != nullptr) gradient->setZero();
  const Eigen::Matrix<double, 3, 2> basis = TangentBasis(direction);
  double cost = 0;
  for (const LineMeasurement& measurement : measurements) {
    const Mat3& rotation = measurement.cam_from_world.rotation;
    const Vec3 arm = point - measurement.cam_from_world.Center();
    const Vec3 normal = rotation * arm.cross(direction);
    Eigen::Matrix<double, 3, 4> by_unknowns;
    by_unknowns.leftCols<2>() = -rotation * CrossMatrix(direction) * basis;
    by_unknowns.rightCols<2>() = rotation * CrossMatrix(arm) * basis;
    for (const EndPointRay& end : measurement.rays->ends) {
      Eigen::RowVector3d by_normal;
      const double residual =
          measurement.weight * EndPointDistancePx(end, normal, &by_normal);
      const Eigen::RowVector4d row =
          measurement.weight * by_normal * by_unknowns;
      *hessian += row.transpose() * row;
      if (gradient != nullptr) *gradient += row.transpose() * residual;
      cost += 0.5 * residual * residual;
    }
  }
  return cost;
}

void RefineLine(const std::vector<LineMeasurement>& measurements, Vec3* point,
                Vec3* direction) {
  constexpr int kIterations = 20;
  double damping = 1e-6;
  Eigen::Matrix4d hessian;
  Vec4 gradient;
  double cost = LineNormalEquations(measurements, *point, *direction, &hessian,
                                    &gradient);
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::Matrix4d damped = hessian;
    damped.diagonal() *= 1 + damping;
    const Vec4 step = -damped.ldlt().solve(gradient);
    if (!step.allFinite()) return;
    const Eigen::Matrix<double, 3, 2> basis = TangentBasis(*direction);
    const Vec3 next_point = *point + basis * step.head<2>();
    const Vec3 next_direction =
        (*direction + basis * step.tail<2>()).normalized();
    Eigen::Matrix4d next_hessian;
    Vec4 next_gradient;
    const double next_cost =
        LineNormalEquations(measurements, next_point, next_direction,
                            &next_hessian, &next_gradient);
    if (!(next_cost <= cost)) {
      damping *= 10;
      if (damping > 1e6) return;
      continue;
    }
    const bool settled = cost - next_cost <= 1e-12 * cost;
    *point = next_point;
    *direction = next_direction;
    cost = next_cost;
    hessian = next_hessian;
    gradient = next_gradient;
    damping *= 0.1;
    if (settled) return;
  }
}

}  // namespace lowlap
