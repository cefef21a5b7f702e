#include "lowlap/matching/internal/points/point_matching.h"

#include <algorithm>

#include "lowlap/core/internal/requirement.h"
#include "lowlap/matching/internal/points/approximate_nearest_two.h"
#include "lowlap/matching/internal/points/nearest_two.h"

namespace lowlap {
namespace {

bool PassesRatio(const NearestTwo& nearest, double max_ratio) {
  return nearest.index >= 0 && nearest.second_distance2 != NearestTwo::kNone &&
         nearest.distance2 < max_ratio * max_ratio * nearest.second_distance2;
}

}  // namespace

Status PointMatchOptions::Validate() const {
  return Require({{max_ratio > 0 && max_ratio <= 1,
                   "max_ratio of points must lie in (0, 1]"}});
}

std::vector<FeatureMatch> MatchPoints(
    const std::vector<PointDescriptor>& first,
    const std::vector<PointDescriptor>& second,
    const PointMatchOptions& options) {
  const auto find = options.matcher == PointMatcher::kFlann
                        ? FindNearestTwoApproximately
                        : FindNearestTwo;
  const std::vector<NearestTwo> forward = find(first, second);
  std::vector<FeatureMatch> candidates;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (PassesRatio(forward[i], options.max_ratio)) {
      candidates.push_back({static_cast<FeatureIndex>(i),
                            static_cast<FeatureIndex>(forward[i].index)});
    }
  }
  // The way back, only from where it can matter.
  std::vector<PointDescriptor> targets;
  targets.reserve(candidates.size());
  for (const FeatureMatch& match : candidates) {
    targets.push_back(second[match.second]);
  }
  const std::vector<NearestTwo> backward = find(targets, first);
  std::vector<FeatureMatch> matches;
  for (std::size_t c = 0; c < candidates.size(); ++c) {
    if (static_cast<FeatureIndex>(backward[c].index) == candidates[c].first &&
        PassesRatio(backward[c], options.max_ratio)) {
      matches.push_back(candidates[c]);
    }
  }
  return matches;
}

}  // namespace lowlap
