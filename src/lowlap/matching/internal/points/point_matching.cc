#include "lowlap/matching/internal/points/point_matching.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include "lowlap/core/internal/requirement.h"
#include "lowlap/matching/internal/points/nearest_two.h"

namespace lowlap {
namespace {

bool PassesRatio(const NearestTwo& nearest, double max_ratio) {
  return nearest.index >= 0 && nearest.second_distance2 != NearestTwo::kNone &&
         nearest.distance2 < max_ratio * max_ratio * nearest.second_distance2;
}

// Keypoints nearer than this may be one point with two orientations.
constexpr double kSamePlacePx = 3;

// How many of the nearest candidates go along with candidate `n`.
int CountAgreeing(const DetectedFeatures& first, const DetectedFeatures& second,
                  const std::vector<FeatureMatch>& candidates, std::size_t n,
                  const RelaxedPointOptions& options) {
  const Keypoint& from = first.keypoints[candidates[n].first];
  const Keypoint& to = second.keypoints[candidates[n].second];
  std::vector<std::pair<double, std::size_t>> others;
  for (std::size_t i = 0; i < candidates.size(); ++i) {
    const double distance_px =
        (first.keypoints[candidates[i].first].position_px - from.position_px)
            .norm();
    if (distance_px > kSamePlacePx) others.emplace_back(distance_px, i);
  }
  const std::size_t count =
      std::min(others.size(), static_cast<std::size_t>(options.neighbors));
  std::partial_sort(others.begin(),
                    others.begin() + static_cast<std::ptrdiff_t>(count),
                    others.end());
  const Mat2 similarity =
      to.scale_px / from.scale_px *
      Eigen::Rotation2Dd(to.angle_rad - from.angle_rad).toRotationMatrix();
  int agreeing = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const FeatureMatch& other = candidates[others[i].second];
    const Vec2 expected =
        similarity *
        (first.keypoints[other.first].position_px - from.position_px);
    const Vec2 found =
        second.keypoints[other.second].position_px - to.position_px;
    agreeing += (expected - found).norm() <
                options.max_deviation * std::max(expected.norm(), found.norm());
  }
  return agreeing;
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

Status RelaxedPointOptions::Validate() const {
  if (Status s = Require(
          {{starved_below >= 0 && min_agreeing >= 1 &&
                neighbors >= min_agreeing,
            "starved_below must not be negative, min_agreeing at least 1, and "
            "neighbors no less than min_agreeing"},
           {max_deviation > 0 && max_deviation < 1,
            "max_deviation must lie in (0, 1)"}});
      !s) {
    return s;
  }
  return PointMatchOptions{max_ratio}.Validate();
}

std::vector<FeatureMatch> MatchPointsRelaxed(
    const DetectedFeatures& first, const DetectedFeatures& second,
    const std::vector<FeatureMatch>& matches,
    const RelaxedPointOptions& options) {
  const std::vector<FeatureMatch> candidates =
      MatchPoints(first.point_descriptors, second.point_descriptors,
                  {options.max_ratio, options.matcher});
  std::set<FeatureIndex> used1, used2;
  for (const FeatureMatch& match : matches) {
    used1.insert(match.first);
    used2.insert(match.second);
  }
  std::vector<FeatureMatch> result = matches;
  for (std::size_t n = 0; n < candidates.size(); ++n) {
    if (used1.count(candidates[n].first) > 0 ||
        used2.count(candidates[n].second) > 0) {
      continue;
    }
    if (CountAgreeing(first, second, candidates, n, options) >=
        options.min_agreeing) {
      result.push_back(candidates[n]);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace lowlap
