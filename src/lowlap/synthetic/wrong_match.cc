#include "lowlap/synthetic/internal/wrong_match.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <optional>

namespace lowlap {
namespace {

constexpr int kMaxAttempts = 20;

Vec3 AtWrongDepth(const Camera& camera, const Vec3& point, Random* random) {
  const double magnitude = random->Uniform(0.2, 0.7);
  const double log_factor = random->Uniform() < 0.5 ? -magnitude : magnitude;
  const Vec3 center = camera.cam_from_world.Center();
  return center + std::exp(log_factor) * (point - center);
}

Segment3 AtWrongDepth(const Camera& camera, const Segment3& segment,
                      Random* random) {
  const Vec3 start = AtWrongDepth(camera, segment.start, random);
  return {start, AtWrongDepth(camera, segment.end, random)};
}

double Displacement(const Vec2& right, const Vec2& wrong) {
  return (wrong - right).norm();
}

// Across the right line: sliding along it is no displacement.
double Displacement(const Segment2& right, const Segment2& wrong) {
  const Vec2 along = (right.end - right.start).normalized();
  const Vec2 across(-along.y(), along.x());
  return std::max(std::abs(across.dot(wrong.start - right.start)),
                  std::abs(across.dot(wrong.end - right.start)));
}

void DrawAnywhere(const Intrinsic& intrinsic, Random* random, Vec2* pixel) {
  pixel->x() = random->Uniform(0, intrinsic.width_px - 1);
  pixel->y() = random->Uniform(0, intrinsic.height_px - 1);
}

void DrawAnywhere(const Intrinsic& intrinsic, Random* random,
                  Segment2* segment) {
  do {
    DrawAnywhere(intrinsic, random, &segment->start);
    DrawAnywhere(intrinsic, random, &segment->end);
  } while ((segment->end - segment->start).norm() <
           intrinsic.ImageDiagonal() / 40);
}

// The views but the first, each with the neighbour it is reached from, breadth
// first.
std::vector<ViewPair> SpanningTree(const PairGraph& graph,
                                   const std::vector<ViewId>& views) {
  const std::vector<ViewPair> pairs = graph.PairsAmong(views);
  std::vector<ViewPair> tree;
  std::vector<ViewId> reached = {views.front()};
  for (std::size_t next = 0; next < reached.size(); ++next) {
    for (const ViewPair& pair : pairs) {
      if (pair.first != reached[next] && pair.second != reached[next]) continue;
      const ViewId child =
          pair.first == reached[next] ? pair.second : pair.first;
      if (std::find(reached.begin(), reached.end(), child) != reached.end()) {
        continue;
      }
      reached.push_back(child);
      tree.push_back({reached[next], child});
    }
  }
  return tree;
}

template <class Image, class Shape>
Sightings<Image> Wrong(const SyntheticOptions& options,
                       const std::vector<Camera>& cameras,
                       const PairGraph& graph, const std::vector<ViewId>& views,
                       const Shape& truth, Random* random) {
  const double min_displacement = std::max(6.0, 6 * options.noise_px);
  Sightings<Image> sightings;
  std::map<ViewId, Shape> shown = {{views.front(), truth}};
  sightings.images[views.front()] =
      *cameras[views.front().value()].Project(truth);
  for (const auto& [parent, child] : SpanningTree(graph, views)) {
    if (sightings.images.count(parent) == 0) continue;  // left out
    std::optional<Image> image;
    if (options.wrong_fits_epipolar) {
      const Shape& believed = shown.at(parent);
      const std::optional<Image> right =
          cameras[child.value()].Project(believed);
      for (int attempt = 0; attempt < kMaxAttempts && !image; ++attempt) {
        const Shape wrong =
            AtWrongDepth(cameras[parent.value()], believed, random);
        image = cameras[child.value()].Project(wrong);
        if (image && right && Displacement(*right, *image) < min_displacement) {
          image.reset();
        }
        if (image) shown.insert_or_assign(child, wrong);
      }
      if (!image) continue;
    } else {
      DrawAnywhere(cameras[child.value()].intrinsic, random, &image.emplace());
    }
    sightings.images[child] = *image;
    sightings.matches.push_back(
        {std::min(parent, child), std::max(parent, child)});
  }
  return sightings;
}

}  // namespace

Sightings<Vec2> WrongSightings(const SyntheticOptions& options,
                               const std::vector<Camera>& cameras,
                               const PairGraph& graph,
                               const std::vector<ViewId>& views,
                               const Vec3& point_in_world, Random* random) {
  return Wrong<Vec2>(options, cameras, graph, views, point_in_world, random);
}

Sightings<Segment2> WrongSightings(const SyntheticOptions& options,
                                   const std::vector<Camera>& cameras,
                                   const PairGraph& graph,
                                   const std::vector<ViewId>& views,
                                   const Segment3& segment_in_world,
                                   Random* random) {
  return Wrong<Segment2>(options, cameras, graph, views, segment_in_world,
                         random);
}

}  // namespace lowlap
