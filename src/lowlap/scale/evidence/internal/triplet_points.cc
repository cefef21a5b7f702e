#include "lowlap/scale/evidence/internal/triplet_points.h"

#include <cmath>

#include "lowlap/geometry/internal/closest_direction.h"
#include "lowlap/scale/internal/candidate_limits.h"

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

// (v + tau w) as a projection into a view that observes `observed`.
void PushPointSide(ResidualColumn* column, const Vec3& v, const Vec3& w,
                   const Vec3& observed, double focal_px, double tau) {
  const double inverse_depth = 1.0 / (v.z() + tau * w.z());
  const Vec3 v1 = inverse_depth * v, w1 = inverse_depth * w;
  const Vec2 a = focal_px * (v1 - observed * v1.z()).head<2>();
  const Vec2 b = focal_px * (w1 - observed * w1.z()).head<2>();
  Push(column[0], a.x());
  Push(column[1], b.x());
  Push(column[2], a.y());
  Push(column[3], b.y());
  Push(column[4], v1.z());
  Push(column[5], w1.z());
  // Of |a + tau b| / (c + tau d).
  const double least = (w1.z() * a.squaredNorm() - v1.z() * a.dot(b)) /
                       (v1.z() * b.squaredNorm() - w1.z() * a.dot(b));
  Push(column[6], std::isfinite(least) ? least : tau);
}

}  // namespace

TripletPointSolver::TripletPointSolver(const TripletGeometry& geometry)
    : geometry_(geometry),
      with_i_(geometry.cami_from_camj),
      with_k_(geometry.camk_from_camj) {}

std::optional<TripletMidpoints> TripletPointSolver::Midpoints(
    const TripletPoint& point, CandidateStatus* status) const {
  const auto from_i = Midpoint(with_i_, point.in_j, point.in_i, status);
  if (!from_i) return std::nullopt;
  const auto from_k = Midpoint(with_k_, point.in_j, point.in_k, status);
  if (!from_k) return std::nullopt;
  return TripletMidpoints{*from_i, *from_k};
}

RatioCandidate TripletPointSolver::Ratio(
    const TripletPoint& point, const TripletMidpoints& midpoints) const {
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

RatioCandidate TripletPointSolver::Ratio(const TripletPoint& point) const {
  RatioCandidate candidate;
  const auto midpoints = Midpoints(point, &candidate.status);
  return midpoints ? Ratio(point, *midpoints) : candidate;
}

void PointResiduals::Reserve(int count) {
  for (ResidualColumn& column : column_) column.reserve(count);
}

void PointResiduals::Add(const TripletGeometry& geometry,
                         const TripletPoint& point,
                         const TripletMidpoints& midpoints, double log_ratio) {
  const double tau = std::exp(log_ratio);
  const RigidTransform& cami = geometry.cami_from_camj;
  const RigidTransform& camk = geometry.camk_from_camj;
  PushPointSide(column_, camk.rotation * midpoints.from_i, camk.translation,
                point.in_k, geometry.focal_k_px, tau);
  // The scene in i times tau: the projection is the same.
  PushPointSide(column_ + kSide, cami.translation,
                cami.rotation * midpoints.from_k, point.in_i,
                geometry.focal_i_px, tau);
}

void PointResiduals::Evaluate(double tau, int count, float* errors_px) const {
  const float t = static_cast<float>(tau);
  const ResidualColumn* const c = column_;
  const ResidualColumn* const d = column_ + kSide;
  // The mean of two quotients with one division.
  Eigen::Map<Eigen::ArrayXf>(errors_px, count) =
      0.5f *
      (PointSide::DistanceAt(c, t, count) * PointSide::DepthAt(d, t, count) +
       PointSide::DistanceAt(d, t, count) * PointSide::DepthAt(c, t, count)) /
      (PointSide::DepthAt(c, t, count) * PointSide::DepthAt(d, t, count));
}

}  // namespace lowlap
