#include "lowlap/geometry/triangulation.h"

namespace lowlap {

std::optional<Vec2> RayDepths(const RigidTransform& cam2_from_cam1,
                              const Vec3& bearing1, const Vec3& bearing2) {
  const Vec3 center2 = cam2_from_cam1.Center();
  const Vec3 ray2 = cam2_from_cam1.rotation.transpose() * bearing2;
  const double aa = bearing1.squaredNorm(), bb = ray2.squaredNorm();
  const double ab = bearing1.dot(ray2);
  const double determinant = bearing1.cross(ray2).squaredNorm();
  if (!(determinant > 1e-20 * aa * bb)) return std::nullopt;
  const double ac = bearing1.dot(center2), bc = ray2.dot(center2);
  return Vec2((bb * ac - ab * bc) / determinant,
              (ab * ac - aa * bc) / determinant);
}

std::optional<Vec3> TriangulateMidpoint(const RigidTransform& cam2_from_cam1,
                                        const Vec3& bearing1,
                                        const Vec3& bearing2) {
  const std::optional<Vec2> depths =
      RayDepths(cam2_from_cam1, bearing1, bearing2);
  if (!depths || !((*depths)(0) > 0) || !((*depths)(1) > 0)) {
    return std::nullopt;
  }
  const Vec3 on_ray2 = cam2_from_cam1.Inverse() * Vec3((*depths)(1) * bearing2);
  return Vec3(0.5 * ((*depths)(0) * bearing1 + on_ray2));
}

}  // namespace lowlap
