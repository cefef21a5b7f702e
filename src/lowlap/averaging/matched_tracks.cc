#include "lowlap/averaging/internal/matched_tracks.h"

#include <algorithm>
#include <utility>

#include "lowlap/core/internal/union_find.h"

namespace lowlap {
namespace {

constexpr double kSamePointPx = 10.0;

using FeatureMatches = std::vector<std::pair<FeatureRef, FeatureRef>>;

bool Exists(const Scene& scene, const FeatureRef& ref) {
  const auto found = scene.features.find(ref.view);
  return found != scene.features.end() &&
         ref.feature < found->second.points_px.size();
}

FeatureMatches CollectMatches(const Scene& scene,
                              const std::vector<ViewId>& views,
                              const std::set<ViewPair>& excluded) {
  const std::set<ViewId> wanted(views.begin(), views.end());
  FeatureMatches matches;
  for (const auto& [pair, pose] : scene.relative_poses) {
    if (excluded.count(pair) > 0 || wanted.count(pair.first) == 0 ||
        wanted.count(pair.second) == 0) {
      continue;
    }
    for (const FeatureMatch& match : pose.point_inliers) {
      const FeatureRef a = {pair.first, match.first};
      const FeatureRef b = {pair.second, match.second};
      if (Exists(scene, a) && Exists(scene, b)) matches.push_back({a, b});
    }
  }
  return matches;
}

// A set of features under construction, one view after the other.
struct JoinedSet {
  Track track;            // the first feature of every view
  Track of_current_view;  // all features of the last one
  bool is_contradictory = false;

  // `ref`, whose view is not before the current one.
  void Add(const Scene& scene, const FeatureRef& ref) {
    if (is_contradictory) return;
    if (track.empty() || track.back().view != ref.view) {
      track.push_back(ref);
      of_current_view.clear();
    }
    const auto& points_px = scene.features.at(ref.view).points_px;
    for (const FeatureRef& other : of_current_view) {
      const Vec2 offset = points_px[other.feature] - points_px[ref.feature];
      if (!(offset.norm() <= kSamePointPx)) is_contradictory = true;
    }
    of_current_view.push_back(ref);
  }
};

}  // namespace

std::map<PointTrackId, Track> MatchedTracks(
    const Scene& scene, const std::vector<ViewId>& views,
    const std::set<ViewPair>& excluded) {
  const bool has_matches = std::any_of(
      scene.relative_poses.begin(), scene.relative_poses.end(),
      [](const auto& entry) { return !entry.second.point_inliers.empty(); });
  if (!has_matches) return scene.point_tracks;

  const FeatureMatches matches = CollectMatches(scene, views, excluded);
  Track features;  // all, sorted
  for (const auto& [a, b] : matches) {
    features.push_back(a);
    features.push_back(b);
  }
  std::sort(features.begin(), features.end());
  features.erase(std::unique(features.begin(), features.end()), features.end());
  const auto index = [&](const FeatureRef& ref) {
    return static_cast<std::size_t>(
        std::lower_bound(features.begin(), features.end(), ref) -
        features.begin());
  };
  UnionFind sets(features.size());
  for (const auto& [a, b] : matches) sets.Union(index(a), index(b));
  const std::vector<std::size_t> labels = sets.Labels();
  std::map<std::size_t, JoinedSet> joined;
  for (std::size_t n = 0; n < features.size(); ++n) {
    joined[labels[n]].Add(scene, features[n]);
  }
  std::map<PointTrackId, Track> tracks;
  PointTrackId id = 0;
  for (auto& [label, set] : joined) {
    if (set.is_contradictory || set.track.size() < 2) continue;
    tracks.emplace_hint(tracks.end(), id, std::move(set.track));
    ++id;
  }
  return tracks;
}

}  // namespace lowlap
