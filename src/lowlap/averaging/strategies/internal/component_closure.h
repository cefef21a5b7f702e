#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// Directions that differ by so many standard deviations fix a length to a
/// tenth.
inline constexpr double kSeparation = 10;

/// Views whose mutual positions are known up to one scale and translation.
struct RigidComponent {
  std::vector<std::size_t> views;
  std::vector<Vec3> centers;  // in the component's own gauge
  double stddev_rad = 0.01;   // of the directions that made it
};

/// X = scale X_body + translation.
struct ComponentPlacement {
  double scale = 1;
  Vec3 translation = Vec3::Zero();
};

/// Scales and translations, relative to components[0], of all components that
/// shared views fix: a triangle of components is closed like a triangle of
/// directions.
///
///   min sum over b, v in b  |X_v - t_b - s_b x_bv|^2,  x_b of unit size.
///
/// The scales of a solution are the null vector of the problem without t and X
/// (Schur complement). Directions in which it is flat, that is, flatter than
/// ten standard deviations of the directions, leave scales free: a component is
/// placed if its ratio to component 0 is the same in all of them, and positive.
/// A planar ring of four components is such a case. nullopt: not fixed. Cubic
/// in the number of components and shared views.
std::vector<std::optional<ComponentPlacement>> CloseComponents(
    const std::vector<RigidComponent>& components);

}  // namespace lowlap
