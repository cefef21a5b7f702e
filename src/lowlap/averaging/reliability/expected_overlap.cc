#include "lowlap/averaging/reliability/internal/expected_overlap.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>
#include <set>
#include <utility>

#include "lowlap/core/internal/median.h"
#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

constexpr std::size_t kMinPoints = 20;
constexpr std::size_t kMaxPoints = 512;
const double kMinCosine = std::cos(RadFromDeg(30));
constexpr double kMaxZoom = 2;
constexpr double kSameSurface = 1.2;
constexpr int kCells = 16;  // each way
constexpr std::size_t kNeighbors = 5;
constexpr double kReachInCells = 2;

// nullopt: behind the camera, or outside the image.
std::optional<Vec2> PixelInImage(const Intrinsic& intrinsic, const Vec3& x) {
  if (intrinsic.model != CameraModel::kSpherical && !(x.z() > 0)) {
    return std::nullopt;
  }
  const Vec2 pixel = intrinsic.Project(x);
  if (!(pixel.x() >= 0 && pixel.x() < intrinsic.width_px && pixel.y() >= 0 &&
        pixel.y() < intrinsic.height_px)) {
    return std::nullopt;
  }
  if (!intrinsic.HasDistortion()) return pixel;
  // Far outside, a distortion may lead back into the image.
  const std::optional<Vec3> ray = intrinsic.Bearing(pixel);
  if (!ray || ray->dot(x) < (1 - 1e-6) * x.norm()) return std::nullopt;
  return pixel;
}

// Of a pixel in the image.
std::size_t CellOf(const Intrinsic& intrinsic, const Vec2& pixel_px) {
  const auto column =
      static_cast<std::size_t>(kCells * pixel_px.x() / intrinsic.width_px);
  const auto row =
      static_cast<std::size_t>(kCells * pixel_px.y() / intrinsic.height_px);
  return row * kCells + column;
}

// What is seen in a pixel, and how far away.
struct SeenDepth {
  Vec2 pixel_px;
  double depth;
};

// Of each cell, the median depth of what is seen nearest to its centre; NaN if
// that is far from it.
std::vector<double> DepthsOfCells(const Intrinsic& intrinsic,
                                  std::vector<SeenDepth> seen) {
  const Vec2 cell_px = Vec2(intrinsic.width_px, intrinsic.height_px) / kCells;
  const double reach_px = kReachInCells * cell_px.norm();
  std::vector<double> depths;
  for (int row = 0; row < kCells; ++row) {
    for (int column = 0; column < kCells; ++column) {
      const Vec2 center = cell_px.cwiseProduct(Vec2(column + 0.5, row + 0.5));
      std::nth_element(seen.begin(), seen.begin() + kNeighbors - 1, seen.end(),
                       [&](const SeenDepth& a, const SeenDepth& b) {
                         return (a.pixel_px - center).squaredNorm() <
                                (b.pixel_px - center).squaredNorm();
                       });
      if ((seen[kNeighbors - 1].pixel_px - center).norm() > reach_px) {
        depths.push_back(std::numeric_limits<double>::quiet_NaN());
        continue;
      }
      std::vector<double> nearest;
      for (std::size_t n = 0; n < kNeighbors; ++n) {
        nearest.push_back(seen[n].depth);
      }
      depths.push_back(Median(std::move(nearest)));
    }
  }
  return depths;
}

bool Observes(const Landmark& landmark, ViewId view) {
  return std::any_of(
      landmark.observations.begin(), landmark.observations.end(),
      [&](const PointObservation& seen) { return seen.view == view; });
}

}  // namespace

OverlapPredictor::OverlapPredictor(const Scene& scene) {
  std::map<ViewId, std::vector<const Landmark*>> landmarks;
  for (const auto& entry : scene.structure) {
    for (const PointObservation& seen : entry.second.observations) {
      landmarks[seen.view].push_back(&entry.second);
    }
  }
  for (const auto& [view, seen] : landmarks) {
    const Pose* const pose = scene.FindPose(view);
    const Intrinsic* const intrinsic = scene.FindIntrinsic(view);
    if (pose == nullptr || intrinsic == nullptr) continue;
    Camera camera{pose, intrinsic, {}, {}};
    std::vector<SeenDepth> depths;
    const std::size_t count = std::min(seen.size(), kMaxPoints);
    for (std::size_t n = 0; n < count; ++n) {
      const Landmark* const landmark = seen[n * seen.size() / count];
      const Vec3 x = pose->rotation * (landmark->position - pose->center);
      if (const auto pixel = PixelInImage(*intrinsic, x)) {
        camera.points.push_back({landmark->position, x.norm(), landmark});
        depths.push_back({*pixel, x.norm()});
      }
    }
    if (camera.points.size() < kMinPoints) continue;
    camera.depths = DepthsOfCells(*intrinsic, std::move(depths));
    cameras_.emplace(view, std::move(camera));
  }
}

bool OverlapPredictor::Camera::SeesAt(const Vec2& pixel_px, double depth,
                                      double factor) const {
  const double seen = depths[CellOf(*intrinsic, pixel_px)];
  return depth <= factor * seen && seen <= factor * depth;
}

std::vector<OverlapPredictor::Expected> OverlapPredictor::ExpectedPoints(
    const Camera& from, const Camera& to, ViewId to_view) {
  std::vector<Expected> expected;
  for (const SeenPoint& point : from.points) {
    const Vec3 ray_from = point.position - from.pose->center;
    const Vec3 ray_to = point.position - to.pose->center;
    const double depth = ray_to.norm();
    if (depth > kMaxZoom * point.depth || point.depth > kMaxZoom * depth ||
        ray_from.dot(ray_to) < kMinCosine * depth * point.depth) {
      continue;
    }
    const auto pixel = PixelInImage(*to.intrinsic, to.pose->rotation * ray_to);
    if (!pixel || !to.SeesAt(*pixel, depth, kMaxZoom)) continue;
    expected.push_back({{*pixel, Observes(*point.landmark, to_view)},
                        to.SeesAt(*pixel, depth, kSameSurface)});
  }
  return expected;
}

ExpectedOverlap OverlapPredictor::Count(const Camera& from, const Camera& to,
                                        ViewId to_view) {
  const std::vector<Expected> expected = ExpectedPoints(from, to, to_view);
  if (expected.empty()) return {};
  const auto num_found =
      std::count_if(expected.begin(), expected.end(),
                    [](const Expected& e) { return e.seen.is_found; });
  const auto num = static_cast<double>(expected.size());
  return {num / static_cast<double>(from.points.size()),
          static_cast<double>(num_found) / num};
}

std::optional<ExpectedOverlap> OverlapPredictor::Between(ViewId a,
                                                         ViewId b) const {
  const auto first = cameras_.find(a), second = cameras_.find(b);
  if (first == cameras_.end() || second == cameras_.end()) return std::nullopt;
  const ExpectedOverlap forth = Count(first->second, second->second, b);
  const ExpectedOverlap back = Count(second->second, first->second, a);
  return ExpectedOverlap{std::min(forth.share, back.share),
                         std::max(forth.found, back.found)};
}

OverlapRegions OverlapPredictor::RegionsOf(ViewId a, ViewId b,
                                           double min_rate) const {
  const auto first = cameras_.find(a), second = cameras_.find(b);
  if (first == cameras_.end() || second == cameras_.end()) return {};
  const auto regions_in = [&](const Camera& to, ViewId to_view,
                              const Camera& from) {
    std::vector<ExpectedSighting> on_surface;
    for (const Expected& expected : ExpectedPoints(from, to, to_view)) {
      if (expected.is_on_surface) on_surface.push_back(expected.seen);
    }
    return DivideOverlap(std::move(on_surface), min_rate);
  };
  OverlapRegions regions = regions_in(second->second, b, first->second);
  regions += regions_in(first->second, a, second->second);
  return regions;
}

Result<ExpectedOverlaps> PredictOverlaps(const Scene& scene,
                                         const RunContext& context) {
  if (scene.structure.empty()) return ExpectedOverlaps();
  std::set<ViewPair> asked(scene.unrelated_pairs.begin(),
                           scene.unrelated_pairs.end());
  for (const auto& entry : scene.relative_poses) asked.insert(entry.first);
  const std::vector<ViewPair> pairs(asked.begin(), asked.end());
  const OverlapPredictor predictor(scene);
  std::vector<std::optional<ExpectedOverlap>> found(pairs.size());
  LOWLAP_RETURN_IF_ERROR(
      ParallelFor(context, "overlaps", pairs.size(), [&](std::size_t n) {
        found[n] = predictor.Between(pairs[n].first, pairs[n].second);
      }));
  ExpectedOverlaps overlaps;
  for (std::size_t n = 0; n < pairs.size(); ++n) {
    if (found[n]) overlaps.emplace_hint(overlaps.end(), pairs[n], *found[n]);
  }
  return overlaps;
}

}  // namespace lowlap
