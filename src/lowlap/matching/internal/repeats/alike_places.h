#pragma once

#include <vector>

#include "lowlap/matching/internal/points/guided_point_matching.h"
#include "lowlap/matching/internal/repeats/conjugate_translation.h"

namespace lowlap {

/// How far from a keypoint its descriptor looks, in its scale: the radius of
/// SIFT's four by four cells (Lowe 2004).
inline constexpr double kWindowScales = 6;

/// From one copy to the next the distance changes a little. (The orientation of
/// a point that looks the same in several is one of them.)
inline constexpr double kMaxScaleFactor = 1.6;

/// Whether two points of one photograph lie outside each other's windows and
/// are of nearly the same size.
bool MayBeCopies(const PointView& view, int first, int second);

/// How well the place of a point is known, on the plane z = 1.
double PlaceTolerance(const PointView& view, int point);

/// For each of the `points` (indices) of one photograph those of them that
/// look like it elsewhere, outside its window: of the nearest descriptors of
/// every part of the image the eight nearest, up to half again as far as the
/// nearest of all, of nearly the same size. Sorted by the first index.
std::vector<AlikePlaces> FindAlikePlaces(const PointView& view,
                                         const std::vector<int>& points);

}  // namespace lowlap
