#include "lowlap/adjustment/internal/costs/plane_costs.h"

#include "lowlap/adjustment/internal/costs/jacobian_map.h"

namespace lowlap {
namespace {

using ConstVec = Eigen::Map<const Vec3>;

}  // namespace

bool PointOnPlaneCost::Evaluate(const double* const* parameters,
                                double* residuals, double** jacobians) const {
  const Vec3 arm = ConstVec(parameters[0]) - anchor_;
  const ConstVec normal(parameters[1]);
  residuals[0] = weight_ * (normal.dot(arm) - parameters[1][3]);
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) {
    JacobianMap<1, 3>(jacobians[0]) = weight_ * normal.transpose();
  }
  if (jacobians[1] != nullptr) {
    JacobianMap<1, 4>(jacobians[1]) << weight_ * arm.transpose(), -weight_;
  }
  return true;
}

bool LineOnPlaneCost::Evaluate(const double* const* parameters,
                               double* residuals, double** jacobians) const {
  const ConstVec point(parameters[0]), direction(parameters[0] + 3);
  const ConstVec normal(parameters[1]);
  for (int end = 0; end < 2; ++end) {
    const Vec3 arm = point + along_[end] * direction - anchor_;
    residuals[end] = weight_ * (normal.dot(arm) - parameters[1][3]);
    if (jacobians == nullptr) continue;
    if (jacobians[0] != nullptr) {
      JacobianMap<2, 6>(jacobians[0]).row(end) << weight_ * normal.transpose(),
          weight_ * along_[end] * normal.transpose();
    }
    if (jacobians[1] != nullptr) {
      JacobianMap<2, 4>(jacobians[1]).row(end) << weight_ * arm.transpose(),
          -weight_;
    }
  }
  return true;
}

}  // namespace lowlap
