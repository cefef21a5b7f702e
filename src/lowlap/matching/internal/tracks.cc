#include "lowlap/matching/internal/tracks.h"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "lowlap/core/internal/requirement.h"

namespace lowlap {
namespace {

using Matches = std::vector<FeatureMatch> RelativePose::*;

// A match of two features, numbered over all views.
struct Link {
  int a = 0;
  int b = 0;
  bool in_triangle = false;
  double log10_nfa = 0;
  std::size_t pair_inliers = 0;
};

struct FeatureGraph {
  std::vector<FeatureRef> features;  // sorted
  std::vector<Link> links;
};

FeatureGraph CollectLinks(const Scene& scene, Matches matches_of) {
  FeatureGraph graph;
  for (const auto& [views, pose] : scene.relative_poses) {
    for (const FeatureMatch& match : pose.*matches_of) {
      graph.features.push_back({views.first, match.first});
      graph.features.push_back({views.second, match.second});
    }
  }
  std::sort(graph.features.begin(), graph.features.end());
  graph.features.erase(
      std::unique(graph.features.begin(), graph.features.end()),
      graph.features.end());
  const auto index = [&](const FeatureRef& ref) {
    return static_cast<int>(
        std::lower_bound(graph.features.begin(), graph.features.end(), ref) -
        graph.features.begin());
  };
  for (const auto& [views, pose] : scene.relative_poses) {
    const std::vector<FeatureMatch>& matches = pose.*matches_of;
    for (const FeatureMatch& match : matches) {
      Link link;
      link.a = index({views.first, match.first});
      link.b = index({views.second, match.second});
      link.log10_nfa = pose.log10_nfa;
      link.pair_inliers = matches.size();
      graph.links.push_back(link);
    }
  }
  return graph;
}

// A link is in a triangle if its two features have a common neighbour.
void MarkTriangles(FeatureGraph* graph) {
  std::vector<std::vector<int>> neighbors(graph->features.size());
  for (const Link& link : graph->links) {
    neighbors[link.a].push_back(link.b);
    neighbors[link.b].push_back(link.a);
  }
  for (std::vector<int>& list : neighbors) std::sort(list.begin(), list.end());
  for (Link& link : graph->links) {
    const std::vector<int>& a = neighbors[link.a];
    const std::vector<int>& b = neighbors[link.b];
    for (auto i = a.begin(), j = b.begin(); i != a.end() && j != b.end();) {
      if (*i == *j) {
        link.in_triangle = true;
        break;
      }
      *i < *j ? ++i : ++j;
    }
  }
}

bool StrongerLink(const Link& p, const Link& q) {
  const auto key = [](const Link& link) {
    return std::make_tuple(!link.in_triangle, link.log10_nfa,
                           -static_cast<double>(link.pair_inliers), link.a,
                           link.b);
  };
  return key(p) < key(q);
}

// Joins features along links, strongest first, unless `compatible` refuses two
// features of one view to share a track.
std::vector<Track> JoinTracks(
    FeatureGraph graph,
    const std::function<bool(const FeatureRef&, const FeatureRef&)>&
        compatible) {
  MarkTriangles(&graph);
  std::sort(graph.links.begin(), graph.links.end(), StrongerLink);

  const std::size_t count = graph.features.size();
  std::vector<int> track_of(count);
  std::vector<std::vector<int>> members(count);
  for (std::size_t i = 0; i < count; ++i) {
    track_of[i] = static_cast<int>(i);
    members[i] = {static_cast<int>(i)};
  }
  // Members are sorted, and features are sorted by view: a merge meets the
  // features that two tracks have in the same view.
  const auto can_join = [&](const std::vector<int>& a,
                            const std::vector<int>& b) {
    for (std::size_t i = 0, j = 0; i < a.size() && j < b.size();) {
      const ViewId view_a = graph.features[a[i]].view;
      const ViewId view_b = graph.features[b[j]].view;
      if (view_a != view_b) {
        view_a < view_b ? ++i : ++j;
        continue;
      }
      for (std::size_t k = j;
           k < b.size() && graph.features[b[k]].view == view_a; ++k) {
        if (!compatible(graph.features[a[i]], graph.features[b[k]])) {
          return false;
        }
      }
      ++i;
    }
    return true;
  };
  for (const Link& link : graph.links) {
    int into = track_of[link.a];
    int from = track_of[link.b];
    if (into == from || !can_join(members[into], members[from])) continue;
    if (members[into].size() < members[from].size()) std::swap(into, from);
    for (const int member : members[from]) track_of[member] = into;
    std::vector<int> merged;
    std::merge(members[into].begin(), members[into].end(),
               members[from].begin(), members[from].end(),
               std::back_inserter(merged));
    members[into] = std::move(merged);
    members[from].clear();
  }

  std::vector<Track> tracks;
  for (const std::vector<int>& list : members) {
    if (list.size() < 2) continue;
    Track track;
    for (const int member : list) track.push_back(graph.features[member]);
    if (track.front().view != track.back().view) {
      tracks.push_back(std::move(track));
    }
  }
  std::sort(tracks.begin(), tracks.end());
  return tracks;
}

template <class TrackId>
std::map<TrackId, Track> Number(std::vector<Track> tracks) {
  std::map<TrackId, Track> numbered;
  TrackId id = 0;
  for (Track& track : tracks) {
    numbered.emplace_hint(numbered.end(), id, std::move(track));
    ++id;
  }
  return numbered;
}

// Whether one line passes close to all four end points: their principal axis.
bool AreCollinear(const LineSegment& a, const LineSegment& b,
                  double max_distance_px) {
  const std::array<Vec2, 4> ends = {a.start_px, a.end_px, b.start_px, b.end_px};
  const Vec2 mean = 0.25 * (ends[0] + ends[1] + ends[2] + ends[3]);
  Mat2 scatter = Mat2::Zero();
  for (const Vec2& p : ends) scatter += (p - mean) * (p - mean).transpose();
  const Vec2 normal =
      Eigen::SelfAdjointEigenSolver<Mat2>(scatter).eigenvectors().col(0);
  return std::all_of(ends.begin(), ends.end(), [&](const Vec2& p) {
    return std::abs(normal.dot(p - mean)) <= max_distance_px;
  });
}

}  // namespace

Status LineTrackOptions::Validate() const {
  return Require({{max_collinear_distance_px >= 0,
                   "max_collinear_distance_px must not be negative"}});
}

std::map<PointTrackId, Track> BuildPointTracks(const Scene& scene) {
  return Number<PointTrackId>(
      JoinTracks(CollectLinks(scene, &RelativePose::point_inliers),
                 [](const FeatureRef&, const FeatureRef&) { return false; }));
}

std::map<LineTrackId, Track> BuildLineTracks(const Scene& scene,
                                             const LineTrackOptions& options) {
  // Straightened: in the pixels of a pinhole with the same focal lengths.
  const auto find = [&](const FeatureRef& ref) -> std::optional<LineSegment> {
    const auto features = scene.features.find(ref.view);
    if (features == scene.features.end() ||
        ref.feature >= features->second.segments.size()) {
      return std::nullopt;
    }
    LineSegment segment = features->second.segments[ref.feature];
    const Intrinsic* intrinsic = scene.FindIntrinsic(ref.view);
    if (intrinsic == nullptr || !intrinsic->HasDistortion()) return segment;
    for (Vec2* end_px : {&segment.start_px, &segment.end_px}) {
      const std::optional<Vec2> end = intrinsic->Normalize(*end_px);
      if (!end) return std::nullopt;
      *end_px = {intrinsic->fx_px * end->x(), intrinsic->fy_px * end->y()};
    }
    return segment;
  };
  return Number<LineTrackId>(
      JoinTracks(CollectLinks(scene, &RelativePose::line_inliers),
                 [&](const FeatureRef& a, const FeatureRef& b) {
                   const auto segment_a = find(a), segment_b = find(b);
                   return segment_a && segment_b &&
                          AreCollinear(*segment_a, *segment_b,
                                       options.max_collinear_distance_px);
                 }));
}

}  // namespace lowlap
