#pragma once

#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/features/internal/image.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/scene/intrinsic.h"
#include "lowlap/study/internal/look_alikes/texture.h"

namespace lowlap {

/// A painted rectangle: the place (u, v) is corner + u u_axis + v v_axis, with
/// unit axes at a right angle, 0 <= u < size_m.x, 0 <= v < size_m.y.
struct Surface {
  Vec3 corner_in_world = Vec3::Zero();
  Vec3 u_axis = Vec3::UnitX();
  Vec3 v_axis = Vec3::UnitY();
  Vec2 size_m = Vec2::Zero();
  Texture texture;
};

/// A photograph of the surfaces, of which the nearest hides the others; where
/// there is none it is white. Each pixel is the mean of 3 x 3 rays, with
/// Gaussian noise of `noise` of 255 greys.
GrayImage Render(const std::vector<Surface>& surfaces,
                 const Intrinsic& intrinsic,
                 const RigidTransform& cam_from_world, double noise,
                 Random* random);

}  // namespace lowlap
