#pragma once

#include <cstddef>
#include <cstdint>

#include "lowlap/scene/scene.h"

namespace lowlap::testing {

/// A valid scene of seven views in which every member of every record is
/// filled: all camera models, fx != fy, a centre prior, a view without
/// intrinsic, one without pose, awkward strings and numbers.
Scene FullScene();

/// A valid random scene of any size: views in a row, landmarks and tracks in
/// neighbouring views, relative poses and ratios of consecutive views.
Scene RandomScene(std::uint64_t seed, std::uint32_t num_views,
                  std::uint32_t num_points, std::uint32_t num_lines);

}  // namespace lowlap::testing
