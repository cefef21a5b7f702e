#include "lowlap/scale/triplet_view.h"

#include <algorithm>
#include <map>
#include <set>
#include <string>
#include <tuple>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/scale/internal/uncertainty/pose_uncertainty.h"

namespace lowlap {
namespace {

// A match seen from the middle view.
struct MiddleMatch {
  FeatureIndex middle = 0;
  FeatureIndex neighbor = 0;
};

std::vector<MiddleMatch> FromMiddle(const std::vector<FeatureMatch>& matches,
                                    bool middle_is_first) {
  std::vector<MiddleMatch> result;
  result.reserve(matches.size());
  for (const FeatureMatch& match : matches) {
    result.push_back(middle_is_first ? MiddleMatch{match.first, match.second}
                                     : MiddleMatch{match.second, match.first});
  }
  return result;
}

// A view of the triplet.
struct SeenView {
  const NormalizedFeatures* features = nullptr;
  const ViewFeatures* raw = nullptr;
  const std::vector<LineTrackId>* line_tracks = nullptr;

  SeenView(const SceneFeatures& scene, ViewId view)
      : features(&scene.normalized.at(view)),
        raw(&scene.scene.features.at(view)),
        line_tracks(&scene.line_tracks.at(view)) {}

  ObservedSegment Observe(FeatureIndex segment) const {
    return {features->segments[segment], raw->segments[segment].stddev_px};
  }
  double SquaredLength(FeatureIndex segment) const {
    const NormalizedSegment& seen = features->segments[segment];
    return (seen.end - seen.start).squaredNorm();
  }
};

Status CheckMatches(const Scene& scene, const RelativePose& edge,
                    const std::vector<FeatureMatch>& matches, bool points) {
  const auto count = [&](ViewId view) -> std::size_t {
    const auto it = scene.features.find(view);
    if (it == scene.features.end()) return 0;
    return points ? it->second.points_px.size() : it->second.segments.size();
  };
  const std::size_t num_first = count(edge.views.first);
  const std::size_t num_second = count(edge.views.second);
  for (const FeatureMatch& match : matches) {
    if (match.first < num_first && match.second < num_second) continue;
    return MakeError(ErrorCode::kInvalidScene,
                     "the relative pose of views " +
                         std::to_string(edge.views.first.value()) + " and " +
                         std::to_string(edge.views.second.value()) +
                         " matches a feature that does not exist");
  }
  return {};
}

// Calls visit(match_ij, match_jk) for all pairs with one middle feature, in the
// order of `ij`.
template <class Visit>
void Chain(const std::vector<MiddleMatch>& ij,
           const std::vector<MiddleMatch>& jk, std::size_t num_middle,
           const Visit& visit) {
  constexpr int kNone = -1;
  std::vector<int> head(num_middle, kNone);
  std::vector<int> next(jk.size(), kNone);
  for (int m = static_cast<int>(jk.size()) - 1; m >= 0; --m) {
    next[m] = head[jk[m].middle];
    head[jk[m].middle] = m;
  }
  for (const MiddleMatch& match : ij) {
    for (int m = head[match.middle]; m != kNone; m = next[m]) {
      visit(match, jk[m]);
    }
  }
}

// Orders points by where the three views show them.
struct ByPlaces {
  bool operator()(const TripletPoint& a, const TripletPoint& b) const {
    const auto places = [](const TripletPoint& point) {
      return std::make_tuple(point.in_i.x(), point.in_i.y(), point.in_j.x(),
                             point.in_j.y(), point.in_k.x(), point.in_k.y());
    };
    return places(a) < places(b);
  }
};

// The longest piece of a line in each view, kInvalidId where there is none. (A
// segment through all pieces is longer, but no better: pieces are matched to a
// line by mistake often enough. Measured on coplanar pairs.)
struct LinePieces {
  FeatureIndex in_middle = kInvalidId;
  FeatureIndex in_neighbor[2] = {kInvalidId, kInvalidId};
};

void KeepLonger(const SeenView& view, FeatureIndex piece,
                FeatureIndex* longest) {
  if (*longest == kInvalidId ||
      view.SquaredLength(piece) > view.SquaredLength(*longest)) {
    *longest = piece;
  }
}

// The relative poses of a triplet, from its middle view to the outer ones.
struct TripletEdges {
  const RelativePose* to_i = nullptr;
  const RelativePose* to_k = nullptr;
};

Result<TripletEdges> FindEdges(const SceneFeatures& features,
                               const ViewTriplet& views,
                               const std::string& name) {
  const Scene& scene = features.scene;
  const TripletEdges edges = {scene.FindRelativePose(views.first, views.middle),
                              scene.FindRelativePose(views.last, views.middle)};
  for (const RelativePose* const edge : {edges.to_i, edges.to_k}) {
    if (edge == nullptr || !features.HasAll(views)) {
      return MakeError(ErrorCode::kInvalidArgument,
                       name +
                           ": a relative pose, or the normalised features "
                           "of a view, are missing");
    }
    LOWLAP_RETURN_IF_ERROR(
        CheckMatches(scene, *edge, edge->point_inliers, true));
    LOWLAP_RETURN_IF_ERROR(
        CheckMatches(scene, *edge, edge->line_inliers, false));
  }
  return edges;
}

std::vector<TripletPoint> PointsOf(const SeenView& i, const SeenView& j,
                                   const SeenView& k,
                                   const std::vector<MiddleMatch>& ij,
                                   const std::vector<MiddleMatch>& jk) {
  std::vector<TripletPoint> points;
  points.reserve(std::min(ij.size(), jk.size()));
  const auto is_valid = [](const Vec3& point) { return point.z() > 0; };
  std::set<TripletPoint, ByPlaces> known;
  Chain(ij, jk, j.features->points.size(),
        [&](const MiddleMatch& match_ij, const MiddleMatch& match_jk) {
          const TripletPoint point{match_ij.middle,
                                   i.features->points[match_ij.neighbor],
                                   j.features->points[match_ij.middle],
                                   k.features->points[match_jk.neighbor]};
          if (is_valid(point.in_i) && is_valid(point.in_j) &&
              is_valid(point.in_k) && known.insert(point).second) {
            points.push_back(point);
          }
        });
  return points;
}

// By track; without one by the segment of the middle view.
using LinesOfMiddle =
    std::map<std::pair<LineTrackId, FeatureIndex>, LinePieces>;

// `n`: of LinePieces::in_neighbor.
void AddPieces(const SeenView& middle, const SeenView& neighbor, int n,
               const std::vector<MiddleMatch>& matches, LinesOfMiddle* lines) {
  for (const MiddleMatch& match : matches) {
    const LineTrackId track = (*middle.line_tracks)[match.middle];
    if ((*neighbor.line_tracks)[match.neighbor] != track) continue;
    LinePieces& pieces =
        (*lines)[{track, track == kInvalidId ? match.middle : 0}];
    KeepLonger(middle, match.middle, &pieces.in_middle);
    KeepLonger(neighbor, match.neighbor, &pieces.in_neighbor[n]);
  }
}

void AddLines(const SeenView& i, const SeenView& j, const SeenView& k,
              const std::vector<MiddleMatch>& ij,
              const std::vector<MiddleMatch>& jk, TripletView* triplet) {
  LinesOfMiddle lines;
  AddPieces(j, i, 0, ij, &lines);
  AddPieces(j, k, 1, jk, &lines);
  for (const auto& [key, pieces] : lines) {
    const auto& [in_i, in_k] = pieces.in_neighbor;
    const ObservedSegment seen = j.Observe(pieces.in_middle);
    if (in_i != kInvalidId) {
      triplet->lines_ij.push_back({pieces.in_middle, seen, i.Observe(in_i)});
    }
    if (in_k != kInvalidId) {
      triplet->lines_jk.push_back({pieces.in_middle, seen, k.Observe(in_k)});
    }
    if (in_i != kInvalidId && in_k != kInvalidId) {
      triplet->lines.push_back(
          {pieces.in_middle, i.Observe(in_i), seen, k.Observe(in_k)});
    }
  }
}

}  // namespace

SceneFeatures::SceneFeatures(const Scene& of_scene) : scene(of_scene) {
  for (const auto& [view, features] : scene.features) {
    const Intrinsic* intrinsic = scene.FindIntrinsic(view);
    if (intrinsic == nullptr) continue;
    normalized.emplace(view, NormalizeFeatures(features, *intrinsic));
    line_tracks[view].resize(features.segments.size(), kInvalidId);
  }
  for (const auto& [id, track] : scene.line_tracks) {
    for (const FeatureRef& ref : track) {
      const auto of_view = line_tracks.find(ref.view);
      if (of_view == line_tracks.end() ||
          ref.feature >= of_view->second.size()) {
        continue;
      }
      LineTrackId& of_segment = of_view->second[ref.feature];
      if (of_segment == kInvalidId) of_segment = id;
    }
  }
}

bool SceneFeatures::HasAll(const ViewTriplet& views) const {
  return normalized.count(views.first) > 0 &&
         normalized.count(views.middle) > 0 && normalized.count(views.last) > 0;
}

Result<TripletView> MakeTripletView(const SceneFeatures& features,
                                    const ViewTriplet& views) {
  const std::string name = "triplet (" + std::to_string(views.first.value()) +
                           ", " + std::to_string(views.middle.value()) + ", " +
                           std::to_string(views.last.value()) + ")";
  const Intrinsic* intrinsic = features.scene.FindIntrinsic(views.middle);
  if (intrinsic == nullptr) {
    return MakeError(ErrorCode::kInvalidArgument,
                     name + ": the middle view has no intrinsic");
  }
  LOWLAP_ASSIGN_OR_RETURN(const TripletEdges edges,
                          FindEdges(features, views, name));
  const SeenView i(features, views.first), j(features, views.middle),
      k(features, views.last);
  const auto from_middle = [&](const RelativePose& edge, auto matches) {
    return FromMiddle(edge.*matches, edge.views.first == views.middle);
  };

  TripletView triplet;
  triplet.views = views;
  triplet.geometry.cami_from_camj =
      UnitTransform(*edges.to_i, views.middle, views.first);
  triplet.geometry.camk_from_camj =
      UnitTransform(*edges.to_k, views.middle, views.last);
  triplet.geometry.focal_i_px = i.features->focal_px;
  triplet.geometry.focal_j_px = j.features->focal_px;
  triplet.geometry.focal_k_px = k.features->focal_px;
  for (const RelativePose* edge : {edges.to_i, edges.to_k}) {
    for (const TripletGeometry& geometry :
         PerturbPose(triplet.geometry, *edge, views)) {
      triplet.pose_perturbations.push_back(geometry);
    }
  }
  triplet.image_area_px2 = intrinsic->ImageArea();
  triplet.image_diagonal_px = intrinsic->ImageDiagonal();
  triplet.points =
      PointsOf(i, j, k, from_middle(*edges.to_i, &RelativePose::point_inliers),
               from_middle(*edges.to_k, &RelativePose::point_inliers));
  AddLines(i, j, k, from_middle(*edges.to_i, &RelativePose::line_inliers),
           from_middle(*edges.to_k, &RelativePose::line_inliers), &triplet);
  return triplet;
}

}  // namespace lowlap
