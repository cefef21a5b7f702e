#include "lowlap/geometry/internal/triangulation.h"

namespace lowlap {

std::optional<Vec3> TriangulateMidpoint(const RigidTransform& cam2_from_cam1,
                                        const Vec3& bearing1,
                                        const Vec3& bearing2) {
  const RayTriangulator triangulator(cam2_from_cam1);
  const std::optional<Vec2> depths = triangulator.Depths(bearing1, bearing2);
  if (!depths || !((*depths)(0) > 0) || !((*depths)(1) > 0)) {
    return std::nullopt;
  }
  return triangulator.Midpoint(bearing1, bearing2, *depths);
}

}  // namespace lowlap
