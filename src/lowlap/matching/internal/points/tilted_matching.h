#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/features/internal/points/point_detector.h"
#include "lowlap/features/internal/points/tilted_points.h"
#include "lowlap/matching/match_options.h"

namespace lowlap {

/// Raised whenever the matches change for the same input and options: what is
/// cached is then computed anew.
inline constexpr int kTiltedMatchingVersion = 2;

/// The points of a view, those that only tilted images show among them, and
/// what they look like from aside. Not owned.
struct TiltedView {
  const std::vector<Keypoint>& keypoints;
  const std::vector<TiltedPoints::Look>& looks;
};

/// `matches`, and those that any two looks of the views show: descriptors that
/// are each other's nearest among all looks, much nearer than the nearest of
/// another place (both ways; places are 4 px apart at least), and whose blobs
/// overlap those of no other match, as they do within 4 px or twice the smaller
/// scale: what such blobs say is not independent. Of several that of the least
/// ratio. Sorted by the first index.
///
/// The cost is that of comparing all descriptors of one view with all of the
/// other.
std::vector<FeatureMatch> MatchTiltedPoints(
    const TiltedView& first, const TiltedView& second,
    const std::vector<FeatureMatch>& matches,
    const TiltedPointOptions& options);

}  // namespace lowlap
