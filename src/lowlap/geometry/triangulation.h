#pragma once

#include <optional>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// Depths of a point along two viewing rays, in each camera's own bearing
/// units: X = depth1 * bearing1 in camera 1. The minimiser of the distance
/// between the two rays. nullopt: parallel rays.
std::optional<Vec2> RayDepths(const RigidTransform& cam2_from_cam1,
                              const Vec3& bearing1, const Vec3& bearing2);

/// The point in camera 1's frame midway between the two viewing rays; nullopt
/// if the rays are parallel or meet behind a camera.
std::optional<Vec3> TriangulateMidpoint(const RigidTransform& cam2_from_cam1,
                                        const Vec3& bearing1,
                                        const Vec3& bearing2);

}  // namespace lowlap
