#include "lowlap/matching/internal/points/tilted_matching.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <tuple>

#include "lowlap/core/internal/requirement.h"
#include "lowlap/matching/internal/points/nearest_two.h"

namespace lowlap {
namespace {

constexpr double kOnePlacePx = 4;
constexpr double kOverlapScales = 2;

bool AreAtOnePlace(const Keypoint& a, const Keypoint& b) {
  return (a.position_px - b.position_px).squaredNorm() <
         kOnePlacePx * kOnePlacePx;
}

// Whether blobs overlap: what they say of their places is not independent.
bool Overlap(const Keypoint& a, const Keypoint& b) {
  const double reach_px =
      std::max(kOnePlacePx, kOverlapScales * std::min(a.scale_px, b.scale_px));
  return (a.position_px - b.position_px).squaredNorm() < reach_px * reach_px;
}

// The nearest of all looks, and the nearest of another place.
struct NearestPlaces {
  int look = -1;
  FeatureIndex point = 0;
  std::int32_t row = -1;
  std::int32_t distance2 = NearestTwo::kNone;
  std::int32_t other_distance2 = NearestTwo::kNone;

  double Ratio() const {
    if (other_distance2 == NearestTwo::kNone || other_distance2 == 0) return 1;
    return std::sqrt(static_cast<double>(distance2) / other_distance2);
  }
};

std::vector<NearestPlaces> FindNearestPlaces(
    const std::vector<PointDescriptor>& queries, const TiltedView& view) {
  std::vector<std::vector<NearestTwo>> found;
  for (const TiltedPoints::Look& look : view.looks) {
    found.push_back(FindNearestTwo(queries, look.descriptors));
  }
  std::vector<NearestPlaces> result(queries.size());
  for (std::size_t n = 0; n < queries.size(); ++n) {
    NearestPlaces& nearest = result[n];
    for (std::size_t l = 0; l < found.size(); ++l) {
      const NearestTwo& in_look = found[l][n];
      if (in_look.index < 0 || in_look.distance2 >= nearest.distance2) continue;
      nearest.look = static_cast<int>(l);
      nearest.row = in_look.index;
      nearest.point = view.looks[l].points[in_look.index];
      nearest.distance2 = in_look.distance2;
    }
    if (nearest.look < 0) continue;
    for (std::size_t l = 0; l < found.size(); ++l) {
      const NearestTwo& in_look = found[l][n];
      if (in_look.index < 0) continue;
      const FeatureIndex point = view.looks[l].points[in_look.index];
      const bool same =
          AreAtOnePlace(view.keypoints[point], view.keypoints[nearest.point]);
      nearest.other_distance2 =
          std::min(nearest.other_distance2,
                   same ? in_look.second_distance2 : in_look.distance2);
    }
  }
  return result;
}

struct LookMatch {
  double ratio;
  FeatureMatch match;
};

bool HasFreePlaces(const TiltedView& first, const TiltedView& second,
                   const FeatureMatch& match,
                   const std::vector<FeatureMatch>& kept) {
  return std::none_of(kept.begin(), kept.end(), [&](const FeatureMatch& other) {
    return Overlap(first.keypoints[match.first],
                   first.keypoints[other.first]) ||
           Overlap(second.keypoints[match.second],
                   second.keypoints[other.second]);
  });
}

}  // namespace

Status TiltedPointOptions::Validate() const {
  return Require({{starved_below >= 0 && enough_pairs >= 0 && max_partners >= 0,
                   "starved_below, enough_pairs and max_partners must not be "
                   "negative"},
                  {max_ratio > 0 && max_ratio <= 1,
                   "max_ratio of tilted points must lie in (0, 1]"}});
}

std::vector<FeatureMatch> MatchTiltedPoints(
    const TiltedView& first, const TiltedView& second,
    const std::vector<FeatureMatch>& matches,
    const TiltedPointOptions& options) {
  std::vector<PointDescriptor> queries;
  std::vector<FeatureIndex> points;
  for (const TiltedPoints::Look& look : first.looks) {
    queries.insert(queries.end(), look.descriptors.begin(),
                   look.descriptors.end());
    points.insert(points.end(), look.points.begin(), look.points.end());
  }
  const auto forward = FindNearestPlaces(queries, second);
  std::vector<PointDescriptor> targets;
  std::vector<LookMatch> candidates;
  for (std::size_t n = 0; n < queries.size(); ++n) {
    const NearestPlaces& nearest = forward[n];
    if (nearest.look < 0 || nearest.Ratio() >= options.max_ratio) continue;
    candidates.push_back({nearest.Ratio(), {points[n], nearest.point}});
    targets.push_back(second.looks[nearest.look].descriptors[nearest.row]);
  }
  const auto backward = FindNearestPlaces(targets, first);
  std::vector<LookMatch> mutual;
  for (std::size_t n = 0; n < candidates.size(); ++n) {
    const double ratio = backward[n].Ratio();
    if (ratio >= options.max_ratio ||
        !AreAtOnePlace(first.keypoints[candidates[n].match.first],
                       first.keypoints[backward[n].point])) {
      continue;
    }
    mutual.push_back(
        {std::max(candidates[n].ratio, ratio), candidates[n].match});
  }
  std::sort(mutual.begin(), mutual.end(),
            [](const LookMatch& a, const LookMatch& b) {
              return std::tie(a.ratio, a.match) < std::tie(b.ratio, b.match);
            });
  std::vector<FeatureMatch> result = matches;
  for (const LookMatch& candidate : mutual) {
    if (HasFreePlaces(first, second, candidate.match, result)) {
      result.push_back(candidate.match);
    }
  }
  std::sort(result.begin(), result.end());
  return result;
}

}  // namespace lowlap
