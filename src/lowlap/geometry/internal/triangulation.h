#pragma once

#include <optional>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// Triangulates many points from the viewing rays of one pair.
class RayTriangulator {
 public:
  explicit RayTriangulator(const RigidTransform& cam2_from_cam1)
      : center2_in_cam1_(cam2_from_cam1.Center()),
        cam1_from_cam2_rotation_(cam2_from_cam1.rotation.transpose()) {}

  /// Depths of a point along two viewing rays, in each camera's own bearing
  /// units: X = depth1 * bearing1 in camera 1. The minimiser of the distance
  /// between the two rays. nullopt: parallel rays.
  std::optional<Vec2> Depths(const Vec3& bearing1, const Vec3& bearing2) const {
    const Vec3 ray2 = cam1_from_cam2_rotation_ * bearing2;
    const double aa = bearing1.squaredNorm(), bb = ray2.squaredNorm();
    const double ab = bearing1.dot(ray2);
    const double determinant = bearing1.cross(ray2).squaredNorm();
    if (!(determinant > 1e-20 * aa * bb)) return std::nullopt;
    const double ac = bearing1.dot(center2_in_cam1_);
    const double bc = ray2.dot(center2_in_cam1_);
    return Vec2((bb * ac - ab * bc) / determinant,
                (ab * ac - aa * bc) / determinant);
  }

  /// The point in camera 1's frame midway between those at the given depths.
  Vec3 Midpoint(const Vec3& bearing1, const Vec3& bearing2,
                const Vec2& depths) const {
    return 0.5 * (depths(0) * bearing1 + center2_in_cam1_ +
                  depths(1) * (cam1_from_cam2_rotation_ * bearing2));
  }

 private:
  Vec3 center2_in_cam1_;
  Mat3 cam1_from_cam2_rotation_;
};

/// The point in camera 1's frame midway between the two viewing rays; nullopt
/// if the rays are parallel or meet behind a camera.
inline std::optional<Vec3> TriangulateMidpoint(
    const RigidTransform& cam2_from_cam1, const Vec3& bearing1,
    const Vec3& bearing2) {
  const RayTriangulator triangulator(cam2_from_cam1);
  const std::optional<Vec2> depths = triangulator.Depths(bearing1, bearing2);
  if (!depths || !((*depths)(0) > 0) || !((*depths)(1) > 0)) {
    return std::nullopt;
  }
  return triangulator.Midpoint(bearing1, bearing2, *depths);
}

}  // namespace lowlap
