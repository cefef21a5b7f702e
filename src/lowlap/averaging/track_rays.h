#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/translation_problem.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The rays of a scene's point tracks in the world frame,
///   ray_in_world = R_view^T bearing(pixel),
/// for the views and camera-from-world rotations given (an observation refers
/// to `views` by its index). Observations of other views, of views without
/// intrinsics and of pixels that cannot be undistorted are left out, and so are
/// tracks with less than two observations then.
///
/// To bound the cost, tracks are taken from the longest to the shortest (ties:
/// by id), each only if one of its views has less than `max_per_view`
/// observations yet. The result is in the order of the track ids.
std::vector<TrackRays> MakeTrackRays(const Scene& scene,
                                     const std::vector<ViewId>& views,
                                     const std::vector<Mat3>& cam_from_world,
                                     std::size_t max_per_view = 300);

}  // namespace lowlap
