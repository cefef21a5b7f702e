#include "lowlap/geometry/closest_direction.h"

#include <cmath>

namespace lowlap {

std::optional<double> ClosestDirection(const Vec3& u, const Vec3& v,
                                       const Vec3& w) {
  constexpr double kParallelSine = 1e-9;
  const double uv = u.dot(v), uw = u.dot(w), vw = v.dot(w);
  const double vv = v.squaredNorm(), ww = w.squaredNorm(), uu = u.squaredNorm();
  const double cross = v.cross(w).squaredNorm();
  if (!(uu > 0) || !(cross > kParallelSine * kParallelSine * vv * ww)) {
    return std::nullopt;
  }
  const double numerator = uw * vv - uv * vw;
  const double denominator = uv * ww - uw * vw;
  if (std::abs(denominator) <= 1e-12 * std::sqrt(uu * vv) * ww) {
    return std::nullopt;
  }
  return numerator / denominator;
}

}  // namespace lowlap
