#include "lowlap/scale/triplet_view.h"

#include <algorithm>
#include <string>
#include <utility>

#include "lowlap/scale/internal/fragmented_segments.h"
#include "lowlap/scale/internal/uncertainty/pose_uncertainty.h"

namespace lowlap {
namespace {

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

// One neighbour of the middle view.
struct Neighbor {
  const RelativePose* edge = nullptr;
  const NormalizedFeatures* features = nullptr;
  const ViewFeatures* raw = nullptr;
  bool middle_is_first = false;
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

ObservedSegment Observe(const NormalizedFeatures& features,
                        const ViewFeatures& raw,
                        const std::vector<FeatureIndex>& pieces) {
  std::vector<ObservedSegment> observed;
  for (const FeatureIndex piece : pieces) {
    observed.push_back(
        {features.segments[piece], raw.segments[piece].stddev_px});
  }
  return LongestPiece(observed);
}

}  // namespace

SceneFeatures::SceneFeatures(const Scene& of_scene) : scene(of_scene) {
  for (const auto& [view, features] : scene.features) {
    const Intrinsic* intrinsic = scene.FindIntrinsic(view);
    if (intrinsic == nullptr) continue;
    normalized.emplace(view, NormalizeFeatures(features, *intrinsic));
  }
}

bool SceneFeatures::HasAll(const ViewTriplet& views) const {
  return normalized.count(views.first) > 0 &&
         normalized.count(views.middle) > 0 && normalized.count(views.last) > 0;
}

Result<TripletView> MakeTripletView(const SceneFeatures& features,
                                    const ViewTriplet& views) {
  const Scene& scene = features.scene;
  const std::string name = "triplet (" + std::to_string(views.first.value()) +
                           ", " + std::to_string(views.middle.value()) + ", " +
                           std::to_string(views.last.value()) + ")";
  const Intrinsic* intrinsic = scene.FindIntrinsic(views.middle);
  if (intrinsic == nullptr) {
    return MakeError(ErrorCode::kInvalidArgument,
                     name + ": the middle view has no intrinsic");
  }
  Neighbor neighbors[2];
  for (int n = 0; n < 2; ++n) {
    const ViewId view = n == 0 ? views.first : views.last;
    Neighbor& neighbor = neighbors[n];
    neighbor.edge = scene.FindRelativePose(view, views.middle);
    if (neighbor.edge == nullptr || features.normalized.count(view) == 0 ||
        features.normalized.count(views.middle) == 0) {
      return MakeError(ErrorCode::kInvalidArgument,
                       name +
                           ": a relative pose, or the normalised features "
                           "of a view, are missing");
    }
    for (const bool points : {true, false}) {
      const Status status = CheckMatches(
          scene, *neighbor.edge,
          points ? neighbor.edge->point_inliers : neighbor.edge->line_inliers,
          points);
      if (!status) return tl::unexpected<Error>(status.error());
    }
    neighbor.features = &features.normalized.at(view);
    neighbor.raw = &scene.features.at(view);
    neighbor.middle_is_first = neighbor.edge->views.first == views.middle;
  }
  const auto& [i, k] = neighbors;
  const NormalizedFeatures& middle = features.normalized.at(views.middle);
  const ViewFeatures& middle_raw = scene.features.at(views.middle);

  TripletView triplet;
  triplet.views = views;
  triplet.geometry.cami_from_camj =
      UnitTransform(*i.edge, views.middle, views.first);
  triplet.geometry.camk_from_camj =
      UnitTransform(*k.edge, views.middle, views.last);
  triplet.geometry.focal_i_px = i.features->focal_px;
  triplet.geometry.focal_j_px = middle.focal_px;
  triplet.geometry.focal_k_px = k.features->focal_px;
  for (const Neighbor& neighbor : neighbors) {
    for (const TripletGeometry& geometry :
         PerturbPose(triplet.geometry, *neighbor.edge, views)) {
      triplet.pose_perturbations.push_back(geometry);
    }
  }
  triplet.image_area_px2 = intrinsic->ImageArea();
  triplet.image_diagonal_px = intrinsic->ImageDiagonal();

  triplet.points.reserve(
      std::min(i.edge->point_inliers.size(), k.edge->point_inliers.size()));
  const auto is_valid = [](const Vec3& point) { return point.z() > 0; };
  Chain(FromMiddle(i.edge->point_inliers, i.middle_is_first),
        FromMiddle(k.edge->point_inliers, k.middle_is_first),
        middle.points.size(),
        [&](const MiddleMatch& ij, const MiddleMatch& jk) {
          const TripletPoint point{ij.middle, i.features->points[ij.neighbor],
                                   middle.points[ij.middle],
                                   k.features->points[jk.neighbor]};
          if (is_valid(point.in_i) && is_valid(point.in_j) &&
              is_valid(point.in_k)) {
            triplet.points.push_back(point);
          }
        });
  const std::vector<MiddleMatch> lines_ij =
      FromMiddle(i.edge->line_inliers, i.middle_is_first);
  const std::vector<MiddleMatch> lines_jk =
      FromMiddle(k.edge->line_inliers, k.middle_is_first);
  const MatchedEdges matched = GroupMatches(lines_ij, lines_jk);
  std::vector<bool> is_new(matched.edges.size(), true);
  for (std::size_t n = 0; n < lines_ij.size(); ++n) {
    const int index = matched.edge_of_ij[n];
    if (!is_new[index]) continue;
    is_new[index] = false;
    const MatchedPieces& edge = matched.edges[index];
    const ObservedSegment in_i = Observe(*i.features, *i.raw, edge.in_i);
    const ObservedSegment in_j = Observe(middle, middle_raw, edge.in_j);
    if (!edge.in_k.empty()) {
      triplet.lines.push_back({lines_ij[n].middle, in_i, in_j,
                               Observe(*k.features, *k.raw, edge.in_k)});
    }
    triplet.lines_ij.push_back({lines_ij[n].middle, in_j, in_i});
  }
  is_new.assign(matched.edges.size(), true);
  for (std::size_t n = 0; n < lines_jk.size(); ++n) {
    const int index = matched.edge_of_jk[n];
    if (!is_new[index]) continue;
    is_new[index] = false;
    const MatchedPieces& edge = matched.edges[index];
    triplet.lines_jk.push_back({lines_jk[n].middle,
                                Observe(middle, middle_raw, edge.in_j),
                                Observe(*k.features, *k.raw, edge.in_k)});
  }
  return triplet;
}

}  // namespace lowlap
