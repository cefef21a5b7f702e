#pragma once

#include <optional>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// An infinite 3D line as (direction, moment): |direction| = 1,
/// moment = X x direction for every X on the line, so moment . direction = 0.
/// The moment is the normal of the plane through the origin and the line, and
/// its length is the line's distance from the origin.
struct PluckerLine {
  Vec3 direction = Vec3::UnitX();
  Vec3 moment = Vec3::Zero();

  static PluckerLine FromPoints(const Vec3& a, const Vec3& b);
  static PluckerLine FromPointAndDirection(const Vec3& point,
                                           const Vec3& direction);

  /// The point of the line that is closest to the origin, d x m.
  Vec3 FootPoint() const { return direction.cross(moment); }
  /// The point of the line that is closest to `point`.
  Vec3 ClosestPointTo(const Vec3& point) const;
};

/// The line in the target frame: d' = R d, m' = R m + t x (R d).
PluckerLine operator*(const RigidTransform& target_from_source,
                      const PluckerLine& line_in_source);

/// A line from its two images, in the frame of the first camera at the given
/// baseline.
///
/// `l1`, `l2`: normals of the interpretation planes, each in its own camera.
/// With q = R^T l2 and b the centre of camera 2 in camera 1:
///   direction = l1 x q / |l1 x q|,  moment = (q . b) / |l1 x q| l1.
/// Degenerate, nullopt: the two planes meet at less than `min_sine` (the line
/// lies near an epipolar plane).
std::optional<PluckerLine> LineFromTwoViews(
    const RigidTransform& cam2_from_cam1, const Vec3& l1, const Vec3& l2,
    double min_sine = 1e-9);

/// The point of `on` that is closest to `to`; nullopt for parallel lines.
std::optional<Vec3> ClosestPointOnLine(const PluckerLine& on,
                                       const PluckerLine& to,
                                       double min_sine = 1e-9);

/// Distance between two lines, parallel ones included.
double LineDistance(const PluckerLine& a, const PluckerLine& b);

/// The point at which the viewing ray `bearing` (from the origin) passes
/// closest to the line; nullopt if ray and line are parallel.
std::optional<Vec3> ClosestPointToRay(const PluckerLine& line,
                                      const Vec3& bearing,
                                      double min_sine = 1e-9);

}  // namespace lowlap
