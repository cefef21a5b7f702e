#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

/// Groups of views whose scale common points fix, most views first (ties: the
/// group whose first two views share more points). A group starts with two
/// views that share `min_points` tracks of at least `min_views` views; their
/// common points are then known up to one scale. A view joins that sees
/// `min_points` known points, and what two views of the group see is known. The
/// views of a group do not depend on the order in which they join. A view may
/// be in several groups, two views in one group are in no other as the first
/// two. Sorted views.
std::vector<std::vector<std::size_t>> GroupViewsByTracks(
    std::size_t num_views, const std::vector<TrackRays>& tracks,
    std::size_t min_views, std::size_t min_points);

}  // namespace lowlap
