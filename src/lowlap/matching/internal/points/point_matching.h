#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
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

}  // namespace lowlap
