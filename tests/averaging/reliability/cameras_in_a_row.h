#pragma once

#include <cstdint>

#include "lowlap/scene/scene.h"

namespace lowlap {

/// Cameras of 1200 x 1200 pixels and 62 degrees that look along z, the n-th
/// at (n spacing, 0, 0); nothing else.
inline Scene CamerasInARow(std::uint32_t num, double spacing) {
  Scene scene;
  Intrinsic& intrinsic = scene.intrinsics[0];
  intrinsic.width_px = intrinsic.height_px = 1200;
  intrinsic.fx_px = intrinsic.fy_px = 1000;
  intrinsic.principal_point_px = Vec2(600, 600);
  for (std::uint32_t view = 0; view < num; ++view) {
    scene.views[view].intrinsic_id = 0;
    scene.views[view].pose_id = view;
    scene.poses[view].center = Vec3(spacing * view, 0, 0);
  }
  return scene;
}

}  // namespace lowlap
