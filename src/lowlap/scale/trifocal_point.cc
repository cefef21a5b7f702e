#include "lowlap/scale/trifocal_point.h"

#include <cmath>

#include "lowlap/geometry/closest_direction.h"
#include "lowlap/geometry/triangulation.h"

namespace lowlap {
namespace {

struct OneEnd {
  double tau = 0;
  double speed_px = 0;  // of the projection into k, per unit of log tau
  // The change of log tau that makes up for a move of the point in j, in
  // normalised coordinates there.
  Vec2 by_middle = Vec2::Zero();
};

std::optional<OneEnd> FromOneEnd(const TripletGeometry& geometry,
                                 const TrifocalPoint& point,
                                 CandidateStatus* status) {
  *status = CandidateStatus::kDegenerate;
  const std::optional<Vec2> depths =
      RayDepths(geometry.cami_from_camj, point.in_j, point.in_i);
  if (!depths) return std::nullopt;
  if (!((*depths)(0) > 0) || !((*depths)(1) > 0)) {
    *status = CandidateStatus::kNegativeDepth;
    return std::nullopt;
  }
  const Vec3 on_ray_i =
      geometry.cami_from_camj.Inverse() * Vec3((*depths)(1) * point.in_i);
  const Vec3 x = 0.5 * ((*depths)(0) * point.in_j + on_ray_i);
  const Vec3 v = geometry.camk_from_camj.rotation * x;
  const Vec3& w = geometry.camk_from_camj.translation;
  const std::optional<double> tau = ClosestDirection(point.in_k, v, w);
  if (!tau) return std::nullopt;
  const Vec3 in_k = v + *tau * w;
  if (!(*tau > 0) || !(in_k.z() > 0) || !(point.in_k.dot(in_k) > 0)) {
    *status = CandidateStatus::kNegativeDepth;
    return std::nullopt;
  }
  *status = CandidateStatus::kValid;
  const Vec2 velocity =
      (*tau / in_k.z()) * (w.head<2>() - (w.z() / in_k.z()) * in_k.head<2>());
  const double speed = velocity.norm();
  Vec2 by_middle;
  for (int axis = 0; axis < 2; ++axis) {
    const Vec3 moved = x.z() * geometry.camk_from_camj.rotation.col(axis);
    const Vec2 in_image =
        (moved.head<2>() - (moved.z() / in_k.z()) * in_k.head<2>()) / in_k.z();
    by_middle(axis) = in_image.dot(velocity) / (speed * speed);
  }
  return OneEnd{*tau, geometry.focal_k_px * speed, by_middle};
}

}  // namespace

std::optional<double> TrifocalPointTau(const TripletGeometry& geometry,
                                       const TrifocalPoint& point,
                                       CandidateStatus* status) {
  const std::optional<OneEnd> end = FromOneEnd(geometry, point, status);
  if (!end) return std::nullopt;
  return end->tau;
}

RatioCandidate TrifocalPointRatio(const TripletGeometry& geometry,
                                  const TrifocalPoint& point) {
  RatioCandidate candidate;
  const std::optional<OneEnd> ijk =
      FromOneEnd(geometry, point, &candidate.status);
  if (!ijk) return candidate;
  const TrifocalPoint swapped{point.point_in_middle, point.in_k, point.in_j,
                              point.in_i};
  const std::optional<OneEnd> kji =
      FromOneEnd(geometry.Swapped(), swapped, &candidate.status);
  if (!kji) return candidate;
  candidate.log_ratio = 0.5 * (std::log(ijk->tau) - std::log(kji->tau));
  const double by_middle =
      (kji->by_middle - ijk->by_middle).norm() / geometry.focal_j_px;
  candidate.log_ratio_stddev =
      std::sqrt(1.0 / (ijk->speed_px * ijk->speed_px) +
                1.0 / (kji->speed_px * kji->speed_px) + by_middle * by_middle);
  if (!(candidate.log_ratio_stddev <= kMaxLogRatioStddev)) {
    candidate.status = CandidateStatus::kDegenerate;
  }
  return candidate;
}

}  // namespace lowlap
