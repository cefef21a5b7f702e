#pragma once

#include "lowlap/geometry/types.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The frame in which a scene is shown: x_shown = scale rotation (X - center).
struct DisplayFrame {
  Mat3 rotation = Mat3::Identity();  // shown_from_world
  Vec3 center = Vec3::Zero();        // in world
  double scale = 1;                  // shown units per world unit

  Vec3 operator()(const Vec3& point_in_world) const {
    return rotation * (point_in_world - center) * scale;
  }
};

/// The z axis is the mean up direction of the cameras, the centre the median of
/// what is shown; nine tenths of it, and every camera, lie within the unit
/// ball. The identity for a scene without poses and structure.
DisplayFrame ChooseDisplayFrame(const Scene& scene);

}  // namespace lowlap
