#include "lowlap/scale/coplanar_ratio.h"

#include <cmath>

namespace lowlap {
namespace {

// Variance that the end points of a segment give to a quantity with gradient
// `gradient` with respect to the segment's unit normal.
double EndPointVariance(const ObservedSegment& observed, const Vec3& gradient,
                        double focal_px) {
  const NormalizedSegment& segment = observed.segment;
  const double length = segment.start.cross(segment.end).norm();
  const Vec2 across = segment.normal.head<2>().normalized();
  const Vec3 move(across.x(), across.y(), 0.0);
  const double by_start = gradient.dot(move.cross(segment.end)) / length;
  const double by_end = gradient.dot(segment.start.cross(move)) / length;
  const double stddev = observed.stddev_px / focal_px;
  return stddev * stddev * (by_start * by_start + by_end * by_end);
}

}  // namespace

std::optional<Vec3> CrossingInMiddle(const NormalizedSegment& a,
                                     const NormalizedSegment& b) {
  const Vec3 x = a.normal.cross(b.normal);
  if (!(std::abs(x.z()) > 1e-9)) return std::nullopt;
  return Vec3(x / x.z());
}

RatioCandidate CoplanarRatio(const TripletGeometry& geometry,
                             const MatchedLine& a, const MatchedLine& b) {
  constexpr double kTiny = 1e-12;
  RatioCandidate candidate;
  const NormalizedSegment& a_j = a.in_middle.segment;
  const NormalizedSegment& b_j = b.in_middle.segment;
  const std::optional<Vec3> x = CrossingInMiddle(a_j, b_j);
  if (!x) return candidate;

  const Mat3& rotation_i = geometry.cami_from_camj.rotation;
  const Mat3& rotation_k = geometry.camk_from_camj.rotation;
  const Vec3 q_a = rotation_i.transpose() * a.in_neighbor.segment.normal;
  const Vec3 q_b = rotation_k.transpose() * b.in_neighbor.segment.normal;
  const Vec3 center_i = geometry.cami_from_camj.Center();
  const Vec3 center_k = geometry.camk_from_camj.Center();
  const double qb_a = q_a.dot(center_i), qx_a = q_a.dot(*x);
  const double qb_b = q_b.dot(center_k), qx_b = q_b.dot(*x);
  if (!(std::abs(qb_a) > kTiny) || !(std::abs(qx_a) > kTiny) ||
      !(std::abs(qb_b) > kTiny) || !(std::abs(qx_b) > kTiny)) {
    return candidate;
  }
  const double z_a = qb_a / qx_a;
  const double z_b = qb_b / qx_b;

  const Vec3 g_a = center_i / qb_a - *x / qx_a;
  const Vec3 g_b = center_k / qb_b - *x / qx_b;
  // x is used with z = 1, while l_a x l_b has its own length; the gradient is
  // with respect to the direction only, so the length divides out.
  const Vec3 h = (q_b / qx_b - q_a / qx_a) / a_j.normal.cross(b_j.normal).z();
  const double variance =
      EndPointVariance(a.in_neighbor, rotation_i * g_a, geometry.focal_i_px) +
      EndPointVariance(b.in_neighbor, rotation_k * g_b, geometry.focal_k_px) +
      EndPointVariance(a.in_middle, b_j.normal.cross(h), geometry.focal_j_px) +
      EndPointVariance(b.in_middle, h.cross(a_j.normal), geometry.focal_j_px);
  candidate.log_ratio_stddev = std::sqrt(variance);
  if (!(candidate.log_ratio_stddev <= kMaxCoplanarLogRatioStddev))
    return candidate;
  if (!(z_a > 0) || !(z_b > 0)) {
    candidate.status = CandidateStatus::kNegativeDepth;
    return candidate;
  }
  candidate.status = CandidateStatus::kValid;
  candidate.log_ratio = std::log(z_a) - std::log(z_b);
  return candidate;
}

}  // namespace lowlap
