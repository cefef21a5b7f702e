#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>

namespace lowlap::internal {

/// The point of the line `on` that is closest to the line `to`; each line is
/// (point, direction). With n = d_on x d_to, D = p_to - p_on:
///   P = p_on + det[D, d_to, n] / |n|^2 d_on.
/// Parallel lines have none; the result is then far away, not NaN.
template <class T>
Eigen::Matrix<T, 3, 1> ClosestPoint(const T* on, const T* to) {
  using Vec = Eigen::Matrix<T, 3, 1>;
  const Eigen::Map<const Vec> p_on(on), d_on(on + 3), p_to(to), d_to(to + 3);
  const Vec n = d_on.cross(d_to);
  const Vec between = p_to - p_on;
  const T along =
      between.cross(Vec(d_to)).dot(n) / (n.squaredNorm() + T(1e-24));
  return p_on + along * d_on;
}

/// r = w f u . m / (|u| |m|),  u = P_ab - C,  m = (p_b - C) x d_b: how far the
/// meeting point, taken on line a, is seen beside line b by a camera at C that
/// sees b; the sine of an angle, times the focal length (1, pixels at the
/// image's centre). Blocks: C (3), line a (6), line b (6).
///
/// Unlike a difference of pixels it is bounded wherever the meeting point lies,
/// and it does not contain the camera's rotation.
struct CoplanarTransferCost {
  double scale_px = 1;  // w f

  template <class T>
  bool operator()(const T* center, const T* line_a, const T* line_b,
                  T* residual) const {
    using Vec = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Vec> c(center), p_b(line_b), d_b(line_b + 3);
    const Vec ray = ClosestPoint(line_a, line_b) - c;
    const Vec normal = Vec(p_b - c).cross(Vec(d_b));
    residual[0] = scale_px * ray.dot(normal) / (ray.norm() * normal.norm());
    return true;
  }
};

/// r = w f (u_ab / |u_ab| - u_ba / |u_ba|): the difference of the images of
/// P_ab and P_ba on the unit sphere about the camera, times the focal length
/// (3 numbers, of which 2 are independent). Blocks: C (3), line a, line b (6).
struct CoplanarImageDistanceCost {
  double scale_px = 1;  // w f

  template <class T>
  bool operator()(const T* center, const T* line_a, const T* line_b,
                  T* residual) const {
    using Vec = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Vec> c(center);
    const Vec ray_a = ClosestPoint(line_a, line_b) - c;
    const Vec ray_b = ClosestPoint(line_b, line_a) - c;
    Eigen::Map<Vec> out(residual);
    out = T(scale_px) * (ray_a / ray_a.norm() - ray_b / ray_b.norm());
    return true;
  }
};

}  // namespace lowlap::internal
