#include "lowlap/synthetic/internal/visibility.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace lowlap {
namespace {

constexpr double kNear = 0.3;             // metres
constexpr double kMinFacingCosine = 0.1;  // of the viewing angle to the normal

// Clips a + s (b - a), s in [low, high], to value_a + s (value_b - value_a) >=
// 0. False: nothing is left.
bool ClipToPositive(double value_a, double value_b, double* low, double* high) {
  const double slope = value_b - value_a;
  if (slope == 0) return value_a >= 0;
  const double root = -value_a / slope;
  if (slope > 0) {
    *low = std::max(*low, root);
  } else {
    *high = std::min(*high, root);
  }
  return *low < *high;
}

bool Faces(const Wall& wall, double max_range, const Vec3& center,
           const Vec3& point) {
  const Vec3 to_camera = center - point;
  const double distance = to_camera.norm();
  return distance < max_range &&
         wall.inward.dot(to_camera) > kMinFacingCosine * distance;
}

// The views near enough to the wall, on its inner side.
std::vector<std::vector<ViewId>> ViewsOfWalls(const World& world) {
  std::vector<std::vector<ViewId>> views(world.walls.size());
  for (std::size_t w = 0; w < world.walls.size(); ++w) {
    const Wall& wall = world.walls[w];
    const Vec3 middle = wall.At(0.5, 0.5);
    const double radius = 0.5 * (wall.u.norm() + wall.v.norm());
    for (std::size_t view = 0; view < world.poses.size(); ++view) {
      const Vec3 to_camera = world.poses[view].center - middle;
      if (to_camera.norm() < world.max_range + radius &&
          wall.inward.dot(to_camera) > 0) {
        views[w].push_back(static_cast<ViewId>(view));
      }
    }
  }
  return views;
}

}  // namespace

bool Camera::Contains(const Vec2& pixel_px) const {
  return pixel_px.x() >= 0 && pixel_px.x() <= intrinsic.width_px - 1 &&
         pixel_px.y() >= 0 && pixel_px.y() <= intrinsic.height_px - 1;
}

std::optional<Vec2> Camera::Project(const Vec3& point_in_world) const {
  const Vec3 point_in_cam = cam_from_world * point_in_world;
  if (point_in_cam.z() < kNear) return std::nullopt;
  const Vec2 pixel = intrinsic.Project(point_in_cam);
  if (!Contains(pixel)) return std::nullopt;
  return pixel;
}

std::optional<Segment2> Camera::Project(
    const Segment3& segment_in_world) const {
  const Vec3 a = cam_from_world * segment_in_world.start;
  const Vec3 b = cam_from_world * segment_in_world.end;
  // The view frustum's planes, as functions that are >= 0 inside.
  const Vec2 pp = intrinsic.principal_point_px;
  const double fx = intrinsic.fx_px, fy = intrinsic.fy_px;
  const double right = intrinsic.width_px - 1 - pp.x();
  const double bottom = intrinsic.height_px - 1 - pp.y();
  double low = 0, high = 1;
  if (!ClipToPositive(a.z() - kNear, b.z() - kNear, &low, &high) ||
      !ClipToPositive(fx * a.x() + pp.x() * a.z(), fx * b.x() + pp.x() * b.z(),
                      &low, &high) ||
      !ClipToPositive(right * a.z() - fx * a.x(), right * b.z() - fx * b.x(),
                      &low, &high) ||
      !ClipToPositive(fy * a.y() + pp.y() * a.z(), fy * b.y() + pp.y() * b.z(),
                      &low, &high) ||
      !ClipToPositive(bottom * a.z() - fy * a.y(), bottom * b.z() - fy * b.y(),
                      &low, &high)) {
    return std::nullopt;
  }
  const Segment2 segment = {intrinsic.Project(a + low * (b - a)),
                            intrinsic.Project(a + high * (b - a))};
  if ((segment.end - segment.start).norm() < intrinsic.ImageDiagonal() / 40) {
    return std::nullopt;
  }
  return segment;
}

std::vector<Camera> BuildCameras(const SyntheticOptions& options,
                                 const World& world) {
  Intrinsic intrinsic;
  intrinsic.width_px = options.width_px;
  intrinsic.height_px = options.height_px;
  intrinsic.fx_px = intrinsic.fy_px = options.focal_px;
  intrinsic.principal_point_px =
      0.5 * Vec2(options.width_px - 1, options.height_px - 1);
  std::vector<Camera> cameras;
  cameras.reserve(world.poses.size());
  for (const Pose& pose : world.poses) {
    cameras.push_back({intrinsic, pose.CamFromWorld()});
  }
  return cameras;
}

std::vector<std::vector<ViewId>> ViewsOfPoints(
    const World& world, const std::vector<Camera>& cameras) {
  const std::vector<std::vector<ViewId>> wall_views = ViewsOfWalls(world);
  std::vector<std::vector<ViewId>> views(world.points.size());
  for (std::size_t i = 0; i < world.points.size(); ++i) {
    const WorldPoint& point = world.points[i];
    for (const ViewId view : wall_views[point.wall]) {
      if (Faces(world.walls[point.wall], world.max_range,
                world.poses[view.value()].center, point.position) &&
          cameras[view.value()].Project(point.position)) {
        views[i].push_back(view);
      }
    }
  }
  return views;
}

std::vector<std::vector<ViewId>> ViewsOfLines(
    const World& world, const std::vector<Camera>& cameras) {
  const std::vector<std::vector<ViewId>> wall_views = ViewsOfWalls(world);
  std::vector<std::vector<ViewId>> views(world.lines.size());
  for (std::size_t i = 0; i < world.lines.size(); ++i) {
    const WorldLine& line = world.lines[i];
    for (const ViewId view : wall_views[line.wall]) {
      if (Faces(world.walls[line.wall], world.max_range,
                world.poses[view.value()].center,
                0.5 * (line.start + line.end)) &&
          cameras[view.value()].Project(Segment3{line.start, line.end})) {
        views[i].push_back(view);
      }
    }
  }
  return views;
}

}  // namespace lowlap
