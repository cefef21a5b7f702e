#include "lowlap/synthetic/internal/coplanar_truth.h"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <map>
#include <set>
#include <utility>

#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxTriplets = 200;

double DistanceToSegment(const Vec2& point, const LineSegment& segment) {
  const Vec2 along = segment.end_px - segment.start_px;
  const double length_squared = along.squaredNorm();
  const double s =
      length_squared > 0
          ? std::clamp(along.dot(point - segment.start_px) / length_squared,
                       0.0, 1.0)
          : 0.0;
  return (point - segment.start_px - s * along).norm();
}

double Side(const Vec2& a, const Vec2& b, const Vec2& point) {
  return (b - a).x() * (point - a).y() - (b - a).y() * (point - a).x();
}

double SegmentDistance(const LineSegment& a, const LineSegment& b) {
  if (Side(a.start_px, a.end_px, b.start_px) *
              Side(a.start_px, a.end_px, b.end_px) <
          0 &&
      Side(b.start_px, b.end_px, a.start_px) *
              Side(b.start_px, b.end_px, a.end_px) <
          0) {
    return 0;
  }
  return std::min(
      {DistanceToSegment(a.start_px, b), DistanceToSegment(a.end_px, b),
       DistanceToSegment(b.start_px, a), DistanceToSegment(b.end_px, a)});
}

// The middle view's segments that are matched with the other view, sorted.
std::vector<FeatureIndex> MatchedSegments(const Scene& scene, ViewId middle,
                                          ViewId other) {
  std::set<FeatureIndex> matched;
  const RelativePose* edge = scene.FindRelativePose(middle, other);
  if (edge == nullptr) return {};
  for (const FeatureMatch& match : edge->line_inliers) {
    matched.insert(middle == edge->views.first ? match.first : match.second);
  }
  return {matched.begin(), matched.end()};
}

using LineOfSegment = std::map<FeatureIndex, LineTrackId>;

LineOfSegment LinesSeenIn(const Scene& scene, ViewId view) {
  LineOfSegment lines;
  for (const auto& [id, track] : scene.line_tracks) {
    for (const FeatureRef& ref : track) {
      if (ref.view == view) lines[ref.feature] = id;
    }
  }
  return lines;
}

bool ShareWall(const SyntheticScene& synthetic, LineTrackId a, LineTrackId b) {
  const auto line_a = synthetic.true_lines.find(a);
  const auto line_b = synthetic.true_lines.find(b);
  if (line_a == synthetic.true_lines.end() ||
      line_b == synthetic.true_lines.end()) {
    return false;  // a wrong match
  }
  for (const int plane : line_a->second.planes) {
    const std::vector<int>& others = line_b->second.planes;
    if (std::find(others.begin(), others.end(), plane) != others.end()) {
      return true;
    }
  }
  return false;
}

std::vector<CoplanarCandidate> Candidates(const SyntheticScene& synthetic,
                                          const ViewTriplet& triplet,
                                          const LineOfSegment& line_of,
                                          int num_neighbors) {
  const Scene& scene = synthetic.scene;
  const std::vector<FeatureIndex> in_first =
      MatchedSegments(scene, triplet.middle, triplet.first);
  const std::vector<FeatureIndex> in_last =
      MatchedSegments(scene, triplet.middle, triplet.last);
  if (in_first.empty() || in_last.empty()) return {};
  const std::vector<LineSegment>& segments =
      scene.features.at(triplet.middle).segments;

  std::set<std::pair<FeatureIndex, FeatureIndex>> pairs;  // (first, last)
  const auto add_nearest = [&](const std::vector<FeatureIndex>& from,
                               const std::vector<FeatureIndex>& to, bool swap) {
    std::vector<LineTrackId> lines_of_to;
    lines_of_to.reserve(to.size());
    for (const FeatureIndex b : to) lines_of_to.push_back(line_of.at(b));
    std::vector<std::pair<double, FeatureIndex>> nearest;
    for (const FeatureIndex a : from) {
      const LineTrackId line_of_a = line_of.at(a);
      nearest.clear();
      for (std::size_t n = 0; n < to.size(); ++n) {
        if (line_of_a == lines_of_to[n]) continue;
        nearest.emplace_back(SegmentDistance(segments[a], segments[to[n]]),
                             to[n]);
      }
      const std::size_t count = std::min(
          nearest.size(), static_cast<std::size_t>(std::max(0, num_neighbors)));
      std::partial_sort(nearest.begin(),
                        nearest.begin() + static_cast<std::ptrdiff_t>(count),
                        nearest.end());
      for (std::size_t i = 0; i < count; ++i) {
        const FeatureIndex b = nearest[i].second;
        pairs.insert(swap ? std::make_pair(b, a) : std::make_pair(a, b));
      }
    }
  };
  add_nearest(in_first, in_last, false);
  add_nearest(in_last, in_first, true);

  std::vector<CoplanarCandidate> candidates;
  candidates.reserve(pairs.size());
  for (const auto& [a, b] : pairs) {
    candidates.push_back(
        {a, b, ShareWall(synthetic, line_of.at(a), line_of.at(b))});
  }
  return candidates;
}

}  // namespace

std::vector<CoplanarCandidate> CoplanarCandidates(
    const SyntheticScene& synthetic, const ViewTriplet& triplet,
    int num_neighbors) {
  return Candidates(synthetic, triplet,
                    LinesSeenIn(synthetic.scene, triplet.middle),
                    num_neighbors);
}

CandidateCount CountCoplanarCandidates(const SyntheticScene& synthetic,
                                       int num_neighbors) {
  const std::vector<ViewTriplet> triplets =
      FindTriplets(ViewGraph(synthetic.scene));
  const std::size_t count = std::min(triplets.size(), kMaxTriplets);
  std::map<ViewId, LineOfSegment> lines;
  for (const auto& [id, track] : synthetic.scene.line_tracks) {
    for (const FeatureRef& ref : track) lines[ref.view][ref.feature] = id;
  }
  CandidateCount result;
  for (std::size_t i = 0; i < count; ++i) {
    const ViewTriplet& triplet = triplets[i * triplets.size() / count];
    for (const CoplanarCandidate& candidate :
         Candidates(synthetic, triplet, lines[triplet.middle], num_neighbors)) {
      ++result.total;
      if (!candidate.is_coplanar) ++result.wrong;
    }
  }
  return result;
}

}  // namespace lowlap
