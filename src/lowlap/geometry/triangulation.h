#pragma once

#include <optional>
#include <vector>

#include "lowlap/geometry/plucker_line.h"
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

/// A point from two or more views: linear (minimal distance to the rays), then
/// Gauss-Newton on the normalised reprojection error. `bearings` have z = 1.
/// nullopt: parallel rays, or a point behind one of the cameras.
std::optional<Vec3> TriangulatePoint(
    const std::vector<RigidTransform>& cams_from_world,
    const std::vector<Vec3>& bearings);

/// An infinite line from two or more interpretation planes, by SVD of the
/// stacked planes [l^T R | l^T t]: every plane passes through the line.
/// `normals` are unit, each in its own camera. nullopt: the planes meet at
/// less than `min_angle_rad` (all views see the line from one epipolar plane).
std::optional<PluckerLine> TriangulateLine(
    const std::vector<RigidTransform>& cams_from_world,
    const std::vector<Vec3>& normals, double min_angle_rad = 1e-6);

/// The largest angle between two of the viewing rays of a point, in radians.
double TriangulationAngle(const std::vector<RigidTransform>& cams_from_world,
                          const Vec3& point_in_world);

}  // namespace lowlap
