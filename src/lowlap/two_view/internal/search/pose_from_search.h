#pragma once

#include <vector>

#include "lowlap/scene/relative_pose.h"
#include "lowlap/two_view/internal/parallel_directions.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "lowlap/two_view/internal/search/pose_search.h"
#include "lowlap/two_view/internal/shuffled_matches.h"

namespace lowlap {

inline constexpr int kMinMatches = 6;

/// The directions in space that both views of a pair show: those that matched
/// lines connect and, where `num_points` are few, those that may be one.
std::vector<DirectionPair> CommonDirections(const TwoViewInput& input,
                                            int num_points);

/// Matches that were found with a pose do not widen its threshold: at most
/// twice that of the pose is looked for, unless it has none, as one that was
/// given.
TwoViewOptions BoundedByPose(TwoViewOptions options, const TwoViewInput& input,
                             const RelativePose& pose);

/// The relative pose of a candidate of `search` over `matches`, without line
/// inliers. `lone_matches`, if not null, are as in TwoViewResult.
RelativePose PoseFromSearch(const TwoViewInput& input,
                            const ShuffledMatches& matches,
                            const PoseSearch& search,
                            const PoseCandidate& candidate,
                            std::vector<FeatureMatch>* lone_matches);

}  // namespace lowlap
