#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include "averaging/random_problem.h"

namespace lowlap {

/// Views on a ring of radius 5 (heights up to 1), points in a box around it,
/// each seen by `length` neighbouring views; exact rays, no edges.
inline RandomProblem MakeRayRing(std::size_t num_views, std::size_t num_tracks,
                                 std::size_t length, bool closed,
                                 std::uint64_t seed) {
  RandomProblem made;
  Random random(seed);
  for (std::size_t n = 0; n < num_views; ++n) {
    const double angle =
        2 * kPi * static_cast<double>(n) / static_cast<double>(num_views);
    made.centers.push_back(
        {5 * std::cos(angle), random.Uniform(-1, 1), 5 * std::sin(angle)});
    made.problem.views.push_back(static_cast<ViewId>(n));
    made.problem.cam_from_world.push_back(RandomRotation(&random));
  }
  const std::size_t starts = closed ? num_views : num_views - length + 1;
  for (std::size_t k = 0; k < num_tracks; ++k) {
    const Vec3 point = RandomVector(&random, 8.0);
    TrackRays track;
    for (std::size_t n = 0; n < length; ++n) {
      const std::size_t view = (k % starts + n) % num_views;
      track.observations.push_back(
          {view, (point - made.centers[view]).normalized()});
    }
    made.problem.tracks.push_back(track);
  }
  return made;
}

}  // namespace lowlap
