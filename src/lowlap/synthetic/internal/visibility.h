#pragma once

#include <optional>
#include <vector>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/scene/intrinsic.h"
#include "lowlap/synthetic/internal/world.h"

namespace lowlap {

/// A segment of a view, in pixels, or of the world.
struct Segment2 {
  Vec2 start = Vec2::Zero();
  Vec2 end = Vec2::Zero();
};
struct Segment3 {
  Vec3 start = Vec3::Zero();
  Vec3 end = Vec3::Zero();
};

/// A view's camera, without distortion.
struct Camera {
  Intrinsic intrinsic;
  RigidTransform cam_from_world;

  bool Contains(const Vec2& pixel_px) const;
  /// nullopt: nearer than 0.3 m, behind the camera, or outside the image.
  std::optional<Vec2> Project(const Vec3& point_in_world) const;
  /// The part of the segment in the image, clipped; nullopt if it is shorter
  /// than a fortieth of the image's diagonal.
  std::optional<Segment2> Project(const Segment3& segment_in_world) const;
};

std::vector<Camera> BuildCameras(const SyntheticOptions& options,
                                 const World& world);

/// The views that see each point, and each line, of the world, sorted: in the
/// image, on a wall that faces the camera, and in range.
std::vector<std::vector<ViewId>> ViewsOfPoints(
    const World& world, const std::vector<Camera>& cameras);
std::vector<std::vector<ViewId>> ViewsOfLines(
    const World& world, const std::vector<Camera>& cameras);

}  // namespace lowlap
