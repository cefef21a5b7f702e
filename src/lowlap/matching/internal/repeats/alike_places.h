#pragma once

#include <vector>

#include "lowlap/matching/internal/points/guided_point_matching.h"
#include "lowlap/matching/internal/repeats/conjugate_translation.h"

namespace lowlap {

/// How far from a keypoint its descriptor looks, in its scale: the radius of
/// SIFT's four by four cells (Lowe 2004).
inline constexpr double kWindowScales = 6;

/// For each of the `points` (indices) of one photograph those of them that
/// look like it elsewhere, outside its window: of the nearest descriptors of
/// every part of the image the eight nearest, up to half again as far as the
/// nearest of all, of nearly the same size. Sorted by the first index.
std::vector<AlikePlaces> FindAlikePlaces(const PointView& view,
                                         const std::vector<int>& points);

}  // namespace lowlap
