#include "lowlap/scale/trifocal_line.h"

#include <cmath>

#include "lowlap/geometry/closest_direction.h"
#include "lowlap/scale/candidate_combination.h"

namespace lowlap {
namespace {

struct OneEnd {
  double tau = 0;
  double variance = 0;  // from the end points in k
};

// d/d(log tau) of the signed distance of e to the line n(tau) = v + tau w.
double DistanceSpeed(const Vec3& e, const Vec3& v, const Vec3& w, double tau) {
  const Vec3 n = v + tau * w;
  const double length = n.head<2>().norm();
  const double distance = e.dot(n) / length;
  const double length_speed = n.head<2>().dot(w.head<2>()) / length;
  return tau * (e.dot(w) - distance * length_speed) / length;
}

std::optional<OneEnd> FromOneEnd(const TripletGeometry& geometry,
                                 const TrifocalLine& line,
                                 CandidateStatus* status) {
  const std::optional<PluckerLine> in_j = LineInMiddle(
      geometry.cami_from_camj, line.in_j.segment, line.in_i.segment, status);
  if (!in_j) return std::nullopt;
  *status = CandidateStatus::kDegenerate;
  const Mat3& rotation = geometry.camk_from_camj.rotation;
  const Vec3 v = rotation * in_j->moment;
  const Vec3 w =
      geometry.camk_from_camj.translation.cross(rotation * in_j->direction);
  const NormalizedSegment& in_k = line.in_k.segment;
  const std::optional<double> tau = ClosestDirection(in_k.normal, v, w);
  if (!tau) return std::nullopt;
  if (!(*tau > 0)) {
    *status = CandidateStatus::kNegativeDepth;
    return std::nullopt;
  }
  const double start_speed = DistanceSpeed(in_k.start, v, w, *tau);
  const double end_speed = DistanceSpeed(in_k.end, v, w, *tau);
  const double stddev = line.in_k.stddev_px / geometry.focal_k_px;
  *status = CandidateStatus::kValid;
  return OneEnd{*tau, stddev * stddev /
                          (start_speed * start_speed + end_speed * end_speed)};
}

}  // namespace

double DepthOnPlane(const RigidTransform& camn_from_camj, const Vec3& normal_n,
                    const Vec3& x) {
  const Vec3 q = camn_from_camj.rotation.transpose() * normal_n;
  return q.dot(camn_from_camj.Center()) / q.dot(x);
}

std::optional<PluckerLine> LineInMiddle(const RigidTransform& camn_from_camj,
                                        const NormalizedSegment& in_j,
                                        const NormalizedSegment& in_n,
                                        CandidateStatus* status) {
  *status = CandidateStatus::kDegenerate;
  if (!in_j.IsValid() || !in_n.IsValid()) return std::nullopt;
  const std::optional<PluckerLine> line =
      LineFromTwoViews(camn_from_camj, in_j.normal, in_n.normal);
  if (!line || !(line->moment.norm() > 1e-12)) return std::nullopt;
  const double start_depth =
      DepthOnPlane(camn_from_camj, in_n.normal, in_j.start);
  const double end_depth = DepthOnPlane(camn_from_camj, in_n.normal, in_j.end);
  if (!std::isfinite(start_depth) || !std::isfinite(end_depth)) {
    return std::nullopt;
  }
  if (!(start_depth > 0) || !(end_depth > 0)) {
    *status = CandidateStatus::kNegativeDepth;
    return std::nullopt;
  }
  *status = CandidateStatus::kValid;
  return line;
}

std::optional<double> TrifocalLineTau(const TripletGeometry& geometry,
                                      const TrifocalLine& line,
                                      CandidateStatus* status) {
  const std::optional<OneEnd> end = FromOneEnd(geometry, line, status);
  if (!end) return std::nullopt;
  return end->tau;
}

RatioCandidate TrifocalLineRatio(const TripletGeometry& geometry,
                                 const TrifocalLine& line) {
  RatioCandidate candidate;
  const std::optional<OneEnd> ijk =
      FromOneEnd(geometry, line, &candidate.status);
  if (!ijk) return candidate;
  const TrifocalLine swapped{line.segment_in_middle, line.in_k, line.in_j,
                             line.in_i};
  const std::optional<OneEnd> kji =
      FromOneEnd(geometry.Swapped(), swapped, &candidate.status);
  if (!kji) return candidate;
  return CombineEnds(std::log(ijk->tau), std::log(kji->tau),
                     ijk->variance + kji->variance);
}

}  // namespace lowlap
