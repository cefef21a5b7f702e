#pragma once

#include <vector>

#include "lowlap/adjustment/internal/planes/free_landmark.h"

namespace lowlap {

struct Plane {
  Vec3 normal = Vec3::UnitZ();
  double offset = 0;  // normal . x = offset
};

/// How far a landmark is from a plane: the place that is farthest, signed, and
/// the largest deviation of a place across the plane.
struct Across {
  double distance = 0;
  double stddev = 0;
};
Across AcrossPlane(const FreeLandmark& landmark, const Plane& plane);

/// Least squares with the weights 1 / (stddev^2 + thickness^2); the normal on
/// the side of `plane`'s, along which the deviations are taken.
Plane FitPlane(const std::vector<const FreeLandmark*>& members,
               const Plane& plane, double thickness);

/// What the members' distances have beyond their own deviations: t such that
/// the median of |distance| / sqrt(stddev^2 + t^2) is that of a normal error.
/// At least a quarter of the median deviation.
double PlaneThickness(const std::vector<const FreeLandmark*>& members,
                      const Plane& plane);

/// A landmark that a plane holds, and what it may be off besides its own
/// deviation.
struct PlaneMember {
  const FreeLandmark* landmark = nullptr;
  double slack = 0;
};

/// How the members bow about the anchor, as PlaneState::bend. Least squares
/// with the weights 1 / (stddev^2 + slack^2); the plane's tilt and offset are
/// free, and what the bend amounts to over the members' extent is held to zero
/// with the plane's thickness as its deviation.
Mat3 FitBend(const std::vector<PlaneMember>& members, const Plane& plane,
             const Vec3& anchor, double thickness);

}  // namespace lowlap
