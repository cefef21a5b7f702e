#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// Views whose mutual positions are known up to one scale and translation.
struct Body {
  std::vector<std::size_t> views;
  std::vector<Vec3> centers;  // in the body's own gauge
  double stddev_rad = 0.01;   // of the directions that made it
};

/// X = scale X_body + translation.
struct BodyPlacement {
  double scale = 1;
  Vec3 translation = Vec3::Zero();
};

/// Scales and translations, relative to bodies[0], of all bodies that shared
/// views fix: a triangle of bodies is closed like a triangle of directions.
///
///   min sum over b, v in b  |X_v - t_b - s_b x_bv|^2,  x_b of unit size.
///
/// The scales of a solution are the null vector of the problem without t and X
/// (Schur complement). Directions in which it is flat, that is, flatter than
/// ten standard deviations of the directions, leave scales free: a body is
/// placed if its ratio to body 0 is the same in all of them, and positive.
/// A planar ring of four bodies is such a case. nullopt: not fixed. Cubic in
/// the number of bodies and shared views.
std::vector<std::optional<BodyPlacement>> CloseBodies(
    const std::vector<Body>& bodies);

}  // namespace lowlap
