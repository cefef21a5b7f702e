#pragma once

#include <optional>
#include <vector>

#include "lowlap/geometry/types.h"
#include "lowlap/scene/intrinsic.h"

namespace lowlap {

/// The inverse of Distort on the range around the axis where it is one to one.
///
/// Radial models reduce to one equation p(r) = r (1 + c1 r^2 + c2 r^4 + ...) =
/// r_d, which is monotone up to its fold, the first root of p'; it is solved
/// there by Newton steps kept in a bracket. Brown's tangential part is added by
/// Newton's method in two dimensions. nullopt: the pixel lies beyond the fold,
/// or, for the fisheye, 90 degrees or more off the axis.
std::optional<Vec2> Undistort(CameraModel model,
                              const std::vector<double>& coefficients,
                              const Vec2& distorted);

}  // namespace lowlap
