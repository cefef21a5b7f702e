#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/features/internal/points/point_detector.h"
#include "lowlap/matching/match_options.h"

namespace lowlap {

/// Raised whenever the matches change for the same input and options: what is
/// cached is then computed anew.
inline constexpr int kPointMatchingVersion = 1;

/// Matches that are each other's nearest neighbours and pass the ratio test in
/// both directions; sorted by the first index, every feature at most once.
/// Distances are exact, in integers. With fewer than two descriptors on a
/// side there is no second nearest, hence no match.
std::vector<FeatureMatch> MatchPoints(
    const std::vector<PointDescriptor>& first,
    const std::vector<PointDescriptor>& second,
    const PointMatchOptions& options);

/// Point matches for a pair in which the usual ratio test leaves too few:
/// `matches`, and those of a wider ratio that their surroundings confirm. A
/// match of keypoints (x1, s1, a1), (x2, s2, a2) implies the similarity
/// S = s2/s1 R(a2 - a1); a neighbour (y1, y2) agrees if
///   |S (y1 - x1) - (y2 - x2)| < d max(|S (y1 - x1)|, |y2 - x2|).
/// The neighbours are the other candidates nearest in the first image, unless
/// at the same place (within 3 px). Sorted by the first index, every feature at
/// most once. Quadratic in the number of candidates.
std::vector<FeatureMatch> MatchPointsRelaxed(
    const DetectedFeatures& first, const DetectedFeatures& second,
    const std::vector<FeatureMatch>& matches,
    const RelaxedPointOptions& options);

}  // namespace lowlap
