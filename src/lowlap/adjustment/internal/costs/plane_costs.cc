#include "lowlap/adjustment/internal/costs/plane_costs.h"

#include <cmath>

#include "lowlap/adjustment/internal/costs/jacobian_map.h"

namespace lowlap {
namespace {

using ConstVec = Eigen::Map<const Vec3>;

}  // namespace

bool PlaceOnPlane::Evaluate(const Vec3& place, const double* plane,
                            const double* center, Residual* residual) const {
  const Vec3 arm = place - anchor_;
  const Vec3 ray = place - ConstVec(center);
  const double squared = ray.squaredNorm();
  if (!(squared > 0)) return false;
  const ConstVec normal(plane);
  const double scale = weight_ * distance_ / std::sqrt(squared);
  residual->value = scale * (normal.dot(arm) - plane[3]);
  residual->by_center = residual->value / squared * ray.transpose();
  residual->by_place = scale * normal.transpose() - residual->by_center;
  residual->by_plane << scale * arm.transpose(), -scale;
  return true;
}

bool PointOnPlaneCost::Evaluate(const double* const* parameters,
                                double* residuals, double** jacobians) const {
  PlaceOnPlane::Residual place;
  if (!place_.Evaluate(ConstVec(parameters[0]), parameters[1], parameters[2],
                       &place)) {
    return false;
  }
  residuals[0] = place.value;
  if (jacobians == nullptr) return true;
  if (jacobians[0] != nullptr) JacobianMap<1, 3>(jacobians[0]) = place.by_place;
  if (jacobians[1] != nullptr) JacobianMap<1, 4>(jacobians[1]) = place.by_plane;
  if (jacobians[2] != nullptr) {
    JacobianMap<1, 3>(jacobians[2]) = place.by_center;
  }
  return true;
}

bool LineOnPlaneCost::Evaluate(const double* const* parameters,
                               double* residuals, double** jacobians) const {
  const ConstVec point(parameters[0]), direction(parameters[0] + 3);
  for (int end = 0; end < 2; ++end) {
    PlaceOnPlane::Residual place;
    if (!places_[end].Evaluate(point + along_[end] * direction, parameters[1],
                               parameters[2], &place)) {
      return false;
    }
    residuals[end] = place.value;
    if (jacobians == nullptr) continue;
    if (jacobians[0] != nullptr) {
      JacobianMap<2, 6>(jacobians[0]).row(end) << place.by_place,
          along_[end] * place.by_place;
    }
    if (jacobians[1] != nullptr) {
      JacobianMap<2, 4>(jacobians[1]).row(end) = place.by_plane;
    }
    if (jacobians[2] != nullptr) {
      JacobianMap<2, 3>(jacobians[2]).row(end) = place.by_center;
    }
  }
  return true;
}

}  // namespace lowlap
