#include "lowlap/study/internal/look_alikes/rendering.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>

namespace lowlap {
namespace {

constexpr int kRaysPerSide = 3;

double ToneAlong(const std::vector<Surface>& surfaces, const Vec3& origin,
                 const Vec3& direction) {
  double nearest = std::numeric_limits<double>::infinity();
  double tone = 1;
  for (const Surface& surface : surfaces) {
    const Vec3 normal = surface.u_axis.cross(surface.v_axis);
    const double distance =
        normal.dot(surface.corner_in_world - origin) / normal.dot(direction);
    if (!(distance > 0 && distance < nearest)) continue;
    const Vec3 inner = origin + distance * direction - surface.corner_in_world;
    const Vec2 place(inner.dot(surface.u_axis), inner.dot(surface.v_axis));
    if ((place.array() < 0).any() ||
        (place.array() >= surface.size_m.array()).any()) {
      continue;
    }
    nearest = distance;
    tone = surface.texture.ToneAt(place);
  }
  return tone;
}

}  // namespace

GrayImage Render(const std::vector<Surface>& surfaces,
                 const Intrinsic& intrinsic,
                 const RigidTransform& cam_from_world, double noise,
                 Random* random) {
  GrayImage image;
  image.width = intrinsic.width_px;
  image.height = intrinsic.height_px;
  const Vec3 center = cam_from_world.Center();
  const Mat3 world_from_cam = cam_from_world.rotation.transpose();
  for (int y = 0; y < image.height; ++y) {
    for (int x = 0; x < image.width; ++x) {
      double sum = 0;
      for (int ray = 0; ray < kRaysPerSide * kRaysPerSide; ++ray) {
        const Vec2 offset(ray % kRaysPerSide + 0.5, ray / kRaysPerSide + 0.5);
        const auto bearing = intrinsic.Bearing(
            Vec2(x, y) + offset / kRaysPerSide - Vec2(0.5, 0.5));
        sum += bearing ? ToneAlong(surfaces, center, world_from_cam * *bearing)
                       : 1;
      }
      const double grey =
          255 * sum / (kRaysPerSide * kRaysPerSide) + random->Gaussian(noise);
      image.pixels.push_back(
          static_cast<std::uint8_t>(std::lround(std::clamp(grey, 0.0, 255.0))));
    }
  }
  return image;
}

}  // namespace lowlap
