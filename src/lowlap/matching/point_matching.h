#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/features/point_detector.h"

namespace lowlap {

/// Raised whenever the matches change for the same input and options: what is
/// cached is then computed anew.
inline constexpr int kPointMatchingVersion = 1;

/// How nearest descriptors are found.
enum class PointMatcher {
  kExact,  // exhaustively: the cost grows with the product of the sizes
  kFlann,  // in a tree (FLANN): faster beyond some 200,000 points
};

struct PointMatchOptions {
  /// A match must be closer than this times the second nearest (Lowe 2004,
  /// section 7.1), seen from either image.
  double max_ratio = 0.8;
  PointMatcher matcher = PointMatcher::kExact;

  Status Validate() const;
};

/// Matches that are each other's nearest neighbours and pass the ratio test in
/// both directions; sorted by the first index, every feature at most once.
/// Distances are exact, in integers. With fewer than two descriptors on a
/// side there is no second nearest, hence no match.
std::vector<FeatureMatch> MatchPoints(
    const std::vector<PointDescriptor>& first,
    const std::vector<PointDescriptor>& second,
    const PointMatchOptions& options);

}  // namespace lowlap
