#include "lowlap/scale/evidence/internal/trifocal_point.h"

#include <cmath>

#include "lowlap/geometry/closest_direction.h"

namespace lowlap {
namespace {

std::optional<Vec3> Midpoint(const RayTriangulator& triangulator,
                             const Vec3& in_j, const Vec3& in_neighbor,
                             CandidateStatus* status) {
  const std::optional<Vec2> depths = triangulator.Depths(in_j, in_neighbor);
  if (!depths) {
    *status = CandidateStatus::kDegenerate;
    return std::nullopt;
  }
  if (!((*depths)(0) > 0) || !((*depths)(1) > 0)) {
    *status = CandidateStatus::kNegativeDepth;
    return std::nullopt;
  }
  *status = CandidateStatus::kValid;
  return triangulator.Midpoint(in_j, in_neighbor, *depths);
}

struct OneEnd {
  double tau = 0;
  // Of log tau by a noise of one pixel in the view: 1 / |v|^2, v in pixels.
  double variance = 0;
  // The change of log tau that makes up for a move of the point in j, in
  // normalised coordinates there.
  Vec2 by_middle = Vec2::Zero();
};

// From a point in camera j to its observation in view n.
std::optional<OneEnd> FromOneEnd(const RigidTransform& camn_from_camj,
                                 double focal_px, const Vec3& point_in_j,
                                 const Vec3& observed,
                                 CandidateStatus* status) {
  *status = CandidateStatus::kDegenerate;
  const Vec3 v = camn_from_camj.rotation * point_in_j;
  const Vec3& w = camn_from_camj.translation;
  const std::optional<double> tau = ClosestDirection(observed, v, w);
  if (!tau) return std::nullopt;
  const Vec3 in_n = v + *tau * w;
  if (!(*tau > 0) || !(in_n.z() > 0) || !(observed.dot(in_n) > 0)) {
    *status = CandidateStatus::kNegativeDepth;
    return std::nullopt;
  }
  *status = CandidateStatus::kValid;
  const double inverse_depth = 1.0 / in_n.z();
  const Vec2 image = inverse_depth * in_n.head<2>();
  const Vec2 velocity = (*tau * inverse_depth) * (w.head<2>() - w.z() * image);
  const double inverse_speed2 = 1.0 / velocity.squaredNorm();
  OneEnd end;
  end.tau = *tau;
  end.variance = inverse_speed2 / (focal_px * focal_px);
  const double scale = point_in_j.z() * inverse_depth * inverse_speed2;
  for (int axis = 0; axis < 2; ++axis) {
    const Vec3& moved = camn_from_camj.rotation.col(axis);
    end.by_middle(axis) =
        scale * (moved.head<2>() - moved.z() * image).dot(velocity);
  }
  return end;
}

}  // namespace

TrifocalPointSolver::TrifocalPointSolver(const TripletGeometry& geometry)
    : geometry_(geometry),
      with_i_(geometry.cami_from_camj),
      with_k_(geometry.camk_from_camj) {}

std::optional<TrifocalMidpoints> TrifocalPointSolver::Midpoints(
    const TrifocalPoint& point, CandidateStatus* status) const {
  const auto from_i = Midpoint(with_i_, point.in_j, point.in_i, status);
  if (!from_i) return std::nullopt;
  const auto from_k = Midpoint(with_k_, point.in_j, point.in_k, status);
  if (!from_k) return std::nullopt;
  return TrifocalMidpoints{*from_i, *from_k};
}

RatioCandidate TrifocalPointSolver::Ratio(
    const TrifocalPoint& point, const TrifocalMidpoints& midpoints) const {
  RatioCandidate candidate;
  const std::optional<OneEnd> ijk =
      FromOneEnd(geometry_.camk_from_camj, geometry_.focal_k_px,
                 midpoints.from_i, point.in_k, &candidate.status);
  if (!ijk) return candidate;
  const std::optional<OneEnd> kji =
      FromOneEnd(geometry_.cami_from_camj, geometry_.focal_i_px,
                 midpoints.from_k, point.in_i, &candidate.status);
  if (!kji) return candidate;
  candidate.log_ratio = 0.5 * std::log(ijk->tau / kji->tau);
  const double by_middle2 = (kji->by_middle - ijk->by_middle).squaredNorm() /
                            (geometry_.focal_j_px * geometry_.focal_j_px);
  candidate.log_ratio_stddev =
      std::sqrt(ijk->variance + kji->variance + by_middle2);
  if (!(candidate.log_ratio_stddev <= kMaxLogRatioStddev)) {
    candidate.status = CandidateStatus::kDegenerate;
  }
  return candidate;
}

RatioCandidate TrifocalPointSolver::Ratio(const TrifocalPoint& point) const {
  RatioCandidate candidate;
  const auto midpoints = Midpoints(point, &candidate.status);
  return midpoints ? Ratio(point, *midpoints) : candidate;
}

}  // namespace lowlap
