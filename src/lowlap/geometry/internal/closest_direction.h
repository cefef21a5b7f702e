#pragma once

#include <optional>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// argmin over lambda of |u x (v + lambda w)| / (|u| |v + lambda w|).
///
/// The lambda that turns v + lambda w closest to the line of u. In closed form
///   lambda* = ((u.w)(v.v) - (u.v)(v.w)) / ((u.v)(w.w) - (u.w)(v.w));
/// the stationary point -(u.v)/(u.w) is always the maximum. Every trifocal
/// ratio has this form (Salaün, Marlet, Monasse 2017, section 4; the signs
/// printed there are wrong). The angle is modulo pi: the caller checks that
/// u.(v + lambda w) > 0 where u is a ray.
///
/// Degenerate, nullopt: v almost parallel to w (the feature lies on the
/// baseline or in an epipolar plane), u = 0, or the minimum at infinity.
inline std::optional<double> ClosestDirection(const Vec3& u, const Vec3& v,
                                              const Vec3& w) {
  constexpr double kParallelSine = 1e-9;
  constexpr double kSmall = 1e-12;
  const double uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double vv = v.squaredNorm(), ww = w.squaredNorm(), uu = u.squaredNorm();
  const double cross = v.cross(w).squaredNorm();
  if (!(uu > 0) || !(cross > kParallelSine * kParallelSine * vv * ww)) {
    return std::nullopt;
  }
  const double numerator = uw * vv - uv * vw;
  const double denominator = uv * ww - uw * vw;
  if (denominator * denominator <= kSmall * kSmall * uu * vv * ww * ww) {
    return std::nullopt;
  }
  return numerator / denominator;
}

}  // namespace lowlap
