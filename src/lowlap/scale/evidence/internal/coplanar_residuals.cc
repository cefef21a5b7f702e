#include "lowlap/scale/evidence/internal/coplanar_residuals.h"

#include <cmath>

#include "lowlap/scale/evidence/internal/coplanar_ratio.h"
#include "lowlap/scale/evidence/internal/line_in_middle.h"

namespace lowlap {
namespace {

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
