#include "lowlap/two_view/internal/search/pose_from_search.h"

#include <algorithm>
#include <iterator>
#include <optional>
#include <utility>

#include "lowlap/two_view/internal/lone_matches.h"
#include "lowlap/two_view/internal/planes/refine_on_plane.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"

namespace lowlap {
namespace {

/// More points than these decide alone.
constexpr int kFewPoints = 100;

// Those of `indices` that are points, in their order.
std::vector<FeatureMatch> PointMatches(const TwoViewInput& input,
                                       const ShuffledMatches& matches,
                                       const std::vector<int>& indices) {
  std::vector<int> inliers;
  for (const int i : indices) {
    if (matches.match_of_pair[i] != ShuffledMatches::kCrossing) {
      inliers.push_back(matches.match_of_pair[i]);
    }
  }
  std::sort(inliers.begin(), inliers.end());
  std::vector<FeatureMatch> points;
  points.reserve(inliers.size());
  for (const int m : inliers) points.push_back(input.point_matches[m]);
  return points;
}

}  // namespace

std::vector<DirectionPair> CommonDirections(const TwoViewInput& input,
                                            int num_points) {
  if (input.directions1 == nullptr || input.directions2 == nullptr) return {};
  std::vector<DirectionPair> pairs =
      PairDirections(*input.features1, *input.features2, *input.directions1,
                     *input.directions2, input.line_matches);
  if (num_points < kFewPoints) {
    for (DirectionPair& pair :
         PossibleDirections(*input.directions1, *input.directions2, pairs)) {
      pairs.push_back(std::move(pair));
    }
  }
  return pairs;
}

TwoViewOptions BoundedByPose(TwoViewOptions options, const TwoViewInput& input,
                             const RelativePose& pose) {
  if (pose.point_threshold_px > 0) {
    options.max_threshold_px =
        std::max(2 * PoseSearch::kMinThresholdPx,
                 2 * pose.point_threshold_px / PixelUnit(input));
  }
  return options;
}

RelativePose PoseFromSearch(const TwoViewInput& input,
                            const ShuffledMatches& matches,
                            const PoseSearch& search,
                            const PoseCandidate& candidate,
                            std::vector<FeatureMatch>* lone_matches) {
  const PoseRefinementOptions refinement = search.RefinementOptions(candidate);
  const std::vector<int> borne_out = BorneOutMatches(
      candidate.pose, matches.pairs, candidate.inliers, refinement);
  RelativePose pose;
  pose.views = input.views;
  pose.rotation = candidate.pose.rotation;
  pose.direction = candidate.pose.translation;
  pose.point_inliers = PointMatches(input, matches, candidate.inliers);
  if (lone_matches != nullptr) {
    std::vector<int> lone;
    std::set_difference(candidate.inliers.begin(), candidate.inliers.end(),
                        borne_out.begin(), borne_out.end(),
                        std::back_inserter(lone));
    *lone_matches = PointMatches(input, matches, lone);
  }
  pose.log10_nfa = candidate.support.log10_nfa;
  pose.point_threshold_px = candidate.support.threshold * PixelUnit(input);
  pose.covariance = candidate.plane
                        ? CovarianceOnPlane(candidate.pose, matches.pairs,
                                            *candidate.plane, refinement)
                        : RelativePoseCovariance(candidate.pose, matches.pairs,
                                                 borne_out, refinement);
  return pose;
}

}  // namespace lowlap
