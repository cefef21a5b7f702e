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
std::optional<double> ClosestDirection(const Vec3& u, const Vec3& v,
                                       const Vec3& w);

}  // namespace lowlap
