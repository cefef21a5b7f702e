#include "lowlap/scale/internal/planes/planes_by_pair.h"

#include <Eigen/Geometry>

#include "lowlap/core/internal/parallel.h"

namespace lowlap {
namespace {

Eigen::AlignedBox2d BoxOfMatches(const Scene& scene,
                                 const NormalizedFeatures& in_middle,
                                 ViewId middle, ViewId neighbor) {
  Eigen::AlignedBox2d box;
  const RelativePose* edge = scene.FindRelativePose(middle, neighbor);
  if (edge == nullptr) return box;
  const auto index = [&](const FeatureMatch& match) {
    return edge->views.first == middle ? match.first : match.second;
  };
  for (const FeatureMatch& match : edge->point_inliers) {
    if (index(match) >= in_middle.points.size()) continue;
    const Vec3& point = in_middle.points[index(match)];
    if (point.z() > 0) box.extend(point.head<2>());
  }
  for (const FeatureMatch& match : edge->line_inliers) {
    if (index(match) >= in_middle.segments.size()) continue;
    const NormalizedSegment& segment = in_middle.segments[index(match)];
    if (!segment.IsValid()) continue;
    box.extend(segment.start.head<2>());
    box.extend(segment.end.head<2>());
  }
  return box;
}

PairPlanes PlanesOfPair(const SceneFeatures& features, ViewId middle,
                        ViewId neighbor) {
  const Scene& scene = features.scene;
  const RelativePose* edge = scene.FindRelativePose(middle, neighbor);
  const auto in_middle = features.normalized.find(middle);
  const auto in_neighbor = features.normalized.find(neighbor);
  if (edge == nullptr || in_middle == features.normalized.end() ||
      in_neighbor == features.normalized.end()) {
    return {};
  }
  const bool middle_is_first = edge->views.first == middle;
  const auto indices = [&](const FeatureMatch& match) {
    return middle_is_first ? std::pair(match.first, match.second)
                           : std::pair(match.second, match.first);
  };
  std::vector<MatchedPoint> points;
  for (const FeatureMatch& match : edge->point_inliers) {
    const auto [a, b] = indices(match);
    if (a >= in_middle->second.points.size() ||
        b >= in_neighbor->second.points.size()) {
      continue;
    }
    const Vec3& x = in_middle->second.points[a];
    const Vec3& y = in_neighbor->second.points[b];
    if (x.z() > 0 && y.z() > 0) points.push_back({a, x, y});
  }
  std::vector<MatchedLine> lines;
  const auto observe = [&](ViewId view, FeatureIndex segment) {
    return ObservedSegment{features.normalized.at(view).segments[segment],
                           scene.features.at(view).segments[segment].stddev_px};
  };
  for (const FeatureMatch& match : edge->line_inliers) {
    const auto [a, b] = indices(match);
    if (a >= in_middle->second.segments.size() ||
        b >= in_neighbor->second.segments.size()) {
      continue;
    }
    lines.push_back({a, observe(middle, a), observe(neighbor, b)});
  }
  return FindPlanes(DepthSamples(UnitTransform(*edge, middle, neighbor),
                                 in_middle->second.focal_px,
                                 in_neighbor->second.focal_px, points, lines));
}

}  // namespace

bool PairsOverlap(const SceneFeatures& features, const ViewTriplet& views) {
  const NormalizedFeatures& in_middle = features.normalized.at(views.middle);
  const auto box = [&](ViewId neighbor) {
    return BoxOfMatches(features.scene, in_middle, views.middle, neighbor);
  };
  return box(views.first).intersects(box(views.last));
}

Result<PlanesByPair> FindPlanesByPair(const SceneFeatures& features,
                                      const std::vector<ViewTriplet>& triplets,
                                      const RunContext& context) {
  PlanesByPair planes;
  for (const ViewTriplet& views : triplets) {
    planes[{views.middle, views.first}];
    planes[{views.middle, views.last}];
  }
  std::vector<PlanesByPair::value_type*> pairs;
  for (auto& pair : planes) pairs.push_back(&pair);
  const Status status =
      ParallelFor(context, "planes", pairs.size(), [&](std::size_t n) {
        const auto& [middle, neighbor] = pairs[n]->first;
        pairs[n]->second = PlanesOfPair(features, middle, neighbor);
      });
  if (!status) return tl::unexpected<Error>(status.error());
  return planes;
}

}  // namespace lowlap
