#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/translation_problem.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The rays of a scene's points in the world frame,
///   ray_in_world = R_view^T bearing(pixel),
/// for the views and camera-from-world rotations given (an observation refers
/// to `views` by its index). Tracks are joined anew from the inlier matches of
/// these views, without those of `excluded` pairs, and left out where they
/// contradict themselves, with two points of one view more than 10 px apart
/// (the rule of Pan et al., ECCV 2024): long tracks, where wrong matches
/// gather, would outvote the right ones. A scene without matches keeps its
/// tracks. Observations of other views, of views without intrinsics and of
/// pixels that cannot be undistorted are left out, and so are tracks with less
/// than two observations then.
///
/// To bound the cost, tracks are taken from the longest to the shortest (ties:
/// by first observation), each only if one of its views has less than
/// `max_per_view` observations yet. The result is in the order of the tracks'
/// first observations.
std::vector<TrackRays> MakeTrackRays(const Scene& scene,
                                     const std::vector<ViewId>& views,
                                     const std::vector<Mat3>& cam_from_world,
                                     const std::vector<ViewPair>& excluded = {},
                                     std::size_t max_per_view = 1000);

/// For each of `num_views` views the tracks that observe it, ascending; those
/// of less than `min_views` observations are left out.
std::vector<std::vector<std::size_t>> TracksOfViews(
    const std::vector<TrackRays>& tracks, std::size_t num_views,
    std::size_t min_views = 1);

}  // namespace lowlap
