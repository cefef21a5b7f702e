#include "lowlap/scale/coplanar_ratio.h"

#include <cmath>

namespace lowlap {
namespace {

// What the end points of a segment, each moving across it by a standard
// deviation, do to a quantity with gradient `gradient` with respect to the
// segment's unit normal.
void EndPointMoves(const ObservedSegment& observed, const Vec3& gradient,
                   double focal_px, double* by_start, double* by_end) {
  const NormalizedSegment& segment = observed.segment;
  const double length = segment.start.cross(segment.end).norm();
  const Vec2 across = segment.normal.head<2>().normalized();
  const Vec3 move(across.x(), across.y(), 0.0);
  const double stddev = observed.stddev_px / focal_px;
  *by_start = stddev * gradient.dot(move.cross(segment.end)) / length;
  *by_end = stddev * gradient.dot(segment.start.cross(move)) / length;
}

// The crossing, and both lines at unit baseline.
struct Crossing {
  Vec3 x;
  Vec3 q_a, q_b;
  Vec3 center_i, center_k;
  double qb_a, qx_a, qb_b, qx_b;
};

std::optional<Crossing> Cross(const TripletGeometry& geometry,
                              const MatchedLine& a, const MatchedLine& b) {
  constexpr double kTiny = 1e-12;
  const std::optional<Vec3> x =
      CrossingInMiddle(a.in_middle.segment, b.in_middle.segment);
  if (!x) return std::nullopt;
  Crossing c;
  c.x = *x;
  c.q_a = geometry.cami_from_camj.rotation.transpose() *
          a.in_neighbor.segment.normal;
  c.q_b = geometry.camk_from_camj.rotation.transpose() *
          b.in_neighbor.segment.normal;
  c.center_i = geometry.cami_from_camj.Center();
  c.center_k = geometry.camk_from_camj.Center();
  c.qb_a = c.q_a.dot(c.center_i);
  c.qx_a = c.q_a.dot(c.x);
  c.qb_b = c.q_b.dot(c.center_k);
  c.qx_b = c.q_b.dot(c.x);
  if (!(std::abs(c.qb_a) > kTiny) || !(std::abs(c.qx_a) > kTiny) ||
      !(std::abs(c.qb_b) > kTiny) || !(std::abs(c.qx_b) > kTiny)) {
    return std::nullopt;
  }
  return c;
}

CoplanarNoise NoiseOf(const TripletGeometry& geometry, const MatchedLine& a,
                      const MatchedLine& b, const Crossing& c) {
  const Vec3& l_a = a.in_middle.segment.normal;
  const Vec3& l_b = b.in_middle.segment.normal;
  const Vec3 g_a = c.center_i / c.qb_a - c.x / c.qx_a;
  const Vec3 g_b = c.center_k / c.qb_b - c.x / c.qx_b;
  // x is used with z = 1, while l_a x l_b has its own length; the gradient is
  // with respect to the direction only, so the length divides out.
  const Vec3 h = (c.q_b / c.qx_b - c.q_a / c.qx_a) / l_a.cross(l_b).z();
  CoplanarNoise noise;
  EndPointMoves(a.in_neighbor, geometry.cami_from_camj.rotation * g_a,
                geometry.focal_i_px, &noise.by_first[0], &noise.by_first[1]);
  EndPointMoves(a.in_middle, l_b.cross(h), geometry.focal_j_px,
                &noise.by_first[2], &noise.by_first[3]);
  EndPointMoves(b.in_neighbor, -(geometry.camk_from_camj.rotation * g_b),
                geometry.focal_k_px, &noise.by_last[0], &noise.by_last[1]);
  EndPointMoves(b.in_middle, h.cross(l_a), geometry.focal_j_px,
                &noise.by_last[2], &noise.by_last[3]);
  return noise;
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
  RatioCandidate candidate;
  const std::optional<Crossing> crossing = Cross(geometry, a, b);
  if (!crossing) return candidate;
  const CoplanarNoise noise = NoiseOf(geometry, a, b, *crossing);
  double variance = 0;
  for (int n = 0; n < 4; ++n) {
    variance += noise.by_first[n] * noise.by_first[n] +
                noise.by_last[n] * noise.by_last[n];
  }
  candidate.log_ratio_stddev = std::sqrt(variance);
  if (!(candidate.log_ratio_stddev <= kMaxCoplanarLogRatioStddev))
    return candidate;
  const double z_a = crossing->qb_a / crossing->qx_a;
  const double z_b = crossing->qb_b / crossing->qx_b;
  if (!(z_a > 0) || !(z_b > 0)) {
    candidate.status = CandidateStatus::kNegativeDepth;
    return candidate;
  }
  candidate.status = CandidateStatus::kValid;
  candidate.log_ratio = std::log(z_a) - std::log(z_b);
  return candidate;
}

CoplanarNoise NoiseOfCoplanarRatio(const TripletGeometry& geometry,
                                   const MatchedLine& a, const MatchedLine& b) {
  const std::optional<Crossing> crossing = Cross(geometry, a, b);
  return crossing ? NoiseOf(geometry, a, b, *crossing) : CoplanarNoise();
}

}  // namespace lowlap
