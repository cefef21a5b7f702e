#include "lowlap/scale/evidence/internal/coplanar_ratio.h"

#include <cmath>

#include "lowlap/scale/evidence/internal/line_in_middle.h"
#include "lowlap/scale/internal/candidate_limits.h"

namespace lowlap {
namespace {

// By how much the segment's unit normal changes when its start or its end moves
// across it by a standard deviation.
std::array<Vec3, 2> MovesOfNormal(const ObservedSegment& observed,
                                  double focal_px) {
  const NormalizedSegment& segment = observed.segment;
  const double length = segment.start.cross(segment.end).norm();
  const Vec2 across = segment.normal.head<2>().normalized();
  const Vec3 move(across.x(), across.y(), 0.0);
  const double scale = observed.stddev_px / (focal_px * length);
  return {scale * move.cross(segment.end), scale * segment.start.cross(move)};
}

// Where two lines of the middle view cross.
struct Crossing {
  Vec3 x;
  double image_scale;  // z of l_a x l_b
  double qx_a, qx_b;
};

std::optional<Vec3> ScaledCrossing(const Vec3& a, const Vec3& b, double* z) {
  const Vec3 x = a.cross(b);
  *z = x.z();
  if (!(std::abs(x.z()) > 1e-9)) return std::nullopt;
  return Vec3(x / x.z());
}

std::optional<Crossing> Cross(const CoplanarLine& a, const CoplanarLine& b) {
  constexpr double kTiny = 1e-12;
  Crossing c;
  const std::optional<Vec3> x =
      ScaledCrossing(a.normal, b.normal, &c.image_scale);
  if (!x) return std::nullopt;
  c.x = *x;
  c.qx_a = a.q.dot(c.x);
  c.qx_b = b.q.dot(c.x);
  if (!(std::abs(a.qb) > kTiny) || !(std::abs(c.qx_a) > kTiny) ||
      !(std::abs(b.qb) > kTiny) || !(std::abs(c.qx_b) > kTiny)) {
    return std::nullopt;
  }
  return c;
}

CoplanarNoise NoiseOf(const CoplanarLine& a, const CoplanarLine& b,
                      const Crossing& c) {
  const Vec3 g_a = a.center / a.qb - c.x / c.qx_a;
  const Vec3 g_b = b.center / b.qb - c.x / c.qx_b;
  // x is used with z = 1, while l_a x l_b has its own length; the gradient is
  // with respect to the direction only, so the length divides out.
  const Vec3 h = (b.q / c.qx_b - a.q / c.qx_a) / c.image_scale;
  const Vec3 by_normal_a = b.normal.cross(h), by_normal_b = h.cross(a.normal);
  return {{{g_a.dot(a.move_in_neighbor[0]), g_a.dot(a.move_in_neighbor[1]),
            by_normal_a.dot(a.move_in_middle[0]),
            by_normal_a.dot(a.move_in_middle[1])},
           {-g_b.dot(b.move_in_neighbor[0]), -g_b.dot(b.move_in_neighbor[1]),
            by_normal_b.dot(b.move_in_middle[0]),
            by_normal_b.dot(b.move_in_middle[1])}}};
}

CoplanarLine FirstLine(const TripletGeometry& geometry, const MatchedLine& a) {
  return CoplanarLine(geometry.cami_from_camj, geometry.focal_i_px,
                      geometry.focal_j_px, a);
}

CoplanarLine LastLine(const TripletGeometry& geometry, const MatchedLine& b) {
  return CoplanarLine(geometry.camk_from_camj, geometry.focal_k_px,
                      geometry.focal_j_px, b);
}

// (v + tau w) as a projection into a view that observes the line `normal`.
void PushTransferSide(ResidualColumn* column, const Vec3& v, const Vec3& w,
                      const Vec3& normal, double focal_px, double tau) {
  const double depth = v.z() + tau * w.z();
  const double to_px = focal_px / (normal.head<2>().norm() * depth);
  Push(column[0], to_px * normal.dot(v));
  Push(column[1], to_px * normal.dot(w));
  Push(column[2], v.z() / depth);
  Push(column[3], w.z() / depth);
  const double least = -normal.dot(v) / normal.dot(w);
  Push(column[4], std::isfinite(least) ? least : tau);
}

}  // namespace

std::optional<Vec3> CrossingInMiddle(const NormalizedSegment& a,
                                     const NormalizedSegment& b) {
  double z = 0;
  return ScaledCrossing(a.normal, b.normal, &z);
}

CoplanarLine::CoplanarLine(const RigidTransform& camn_from_camj,
                           double focal_n_px, double focal_j_px,
                           const MatchedLine& line)
    : normal(line.in_middle.segment.normal),
      center(camn_from_camj.Center()),
      q(camn_from_camj.rotation.transpose() * line.in_neighbor.segment.normal),
      qb(q.dot(center)),
      move_in_neighbor(MovesOfNormal(line.in_neighbor, focal_n_px)),
      move_in_middle(MovesOfNormal(line.in_middle, focal_j_px)) {
  for (Vec3& move : move_in_neighbor) {
    move = (camn_from_camj.rotation.transpose() * move).eval();
  }
}

RatioCandidate CoplanarRatio(const CoplanarLine& a, const CoplanarLine& b) {
  RatioCandidate candidate;
  const std::optional<Crossing> crossing = Cross(a, b);
  if (!crossing) return candidate;
  const CoplanarNoise noise = NoiseOf(a, b, *crossing);
  double variance = 0;
  for (int n = 0; n < 4; ++n) {
    variance += noise[0][n] * noise[0][n] + noise[1][n] * noise[1][n];
  }
  candidate.log_ratio_stddev = std::sqrt(variance);
  if (!(candidate.log_ratio_stddev <= kMaxPlaneLogRatioStddev)) {
    return candidate;
  }
  const double z_a = a.qb / crossing->qx_a;
  const double z_b = b.qb / crossing->qx_b;
  if (!(z_a > 0) || !(z_b > 0)) {
    candidate.status = CandidateStatus::kNegativeDepth;
    return candidate;
  }
  candidate.status = CandidateStatus::kValid;
  candidate.log_ratio = std::log(z_a / z_b);
  return candidate;
}

RatioCandidate CoplanarRatio(const TripletGeometry& geometry,
                             const MatchedLine& a, const MatchedLine& b) {
  return CoplanarRatio(FirstLine(geometry, a), LastLine(geometry, b));
}

CoplanarNoise NoiseOfCoplanarRatio(const TripletGeometry& geometry,
                                   const MatchedLine& a, const MatchedLine& b) {
  const CoplanarLine line_a = FirstLine(geometry, a);
  const CoplanarLine line_b = LastLine(geometry, b);
  const std::optional<Crossing> crossing = Cross(line_a, line_b);
  return crossing ? NoiseOf(line_a, line_b, *crossing) : CoplanarNoise{};
}

void TransferResiduals::Add(const TripletGeometry& geometry,
                            const MatchedLine& a, const MatchedLine& b,
                            double log_ratio) {
  const double tau = std::exp(log_ratio);
  const RigidTransform& cami = geometry.cami_from_camj;
  const RigidTransform& camk = geometry.camk_from_camj;
  const Vec3& normal_a = a.in_neighbor.segment.normal;
  const Vec3& normal_b = b.in_neighbor.segment.normal;
  const Vec3 x = CrossingInMiddle(a.in_middle.segment, b.in_middle.segment)
                     .value_or(Vec3(Vec3::UnitZ()));
  const Vec3 on_a = DepthOnPlane(cami, normal_a, x) * x;
  const Vec3 on_b = DepthOnPlane(camk, normal_b, x) * x;
  PushTransferSide(column_, camk.rotation * on_a, camk.translation, normal_b,
                   geometry.focal_k_px, tau);
  PushTransferSide(column_ + kSide, cami.translation, cami.rotation * on_b,
                   normal_a, geometry.focal_i_px, tau);
}

}  // namespace lowlap
