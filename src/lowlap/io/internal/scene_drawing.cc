#include "lowlap/io/internal/scene_drawing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lowlap/core/internal/median.h"

namespace lowlap {
namespace {

// Over at most a thousand of the centres, spread evenly.
double MedianNeighbourDistance(const std::vector<Vec3>& centers) {
  const std::size_t step = centers.size() / 1000 + 1;
  std::vector<double> nearest;
  for (std::size_t a = 0; a < centers.size(); a += step) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t b = 0; b < centers.size(); ++b) {
      const double distance = (centers[a] - centers[b]).norm();
      if (distance > 0) least = std::min(least, distance);
    }
    if (std::isfinite(least)) nearest.push_back(least);
  }
  return Median(std::move(nearest));
}

// With one camera the points give the size.
double FrustumDepth(const Scene& scene) {
  std::vector<Vec3> centers;
  for (const auto& [id, pose] : scene.poses) centers.push_back(pose.center);
  const double spacing = MedianNeighbourDistance(centers);
  if (spacing > 0) return 0.25 * spacing;
  std::vector<double> distances;
  for (const auto& [id, landmark] : scene.structure) {
    if (centers.empty()) break;
    distances.push_back((landmark.position - centers.front()).norm());
  }
  const double distance = Median(std::move(distances));
  return distance > 0 ? 0.1 * distance : 1;
}

std::uint32_t AddVertex(const Vec3& position, DrawnKind kind,
                        SceneDrawing* drawing) {
  drawing->vertices.push_back({position, kind});
  return static_cast<std::uint32_t>(drawing->vertices.size() - 1);
}

void DrawCamera(const Pose& pose, const Intrinsic* intrinsic, double depth,
                SceneDrawing* drawing) {
  const std::uint32_t center =
      AddVertex(pose.center, DrawnKind::kCamera, drawing);
  if (!intrinsic || intrinsic->model == CameraModel::kSpherical) return;
  std::array<std::uint32_t, 4> corners;
  for (int n = 0; n < 4; ++n) {
    // Round the image: (0, 0), (w, 0), (w, h), (0, h).
    const Vec2 pixel(n == 1 || n == 2 ? intrinsic->width_px : 0,
                     n >= 2 ? intrinsic->height_px : 0);
    const Vec2 offset = pixel - intrinsic->principal_point_px;
    const Vec3 corner_in_cam(offset.x() / intrinsic->fx_px * depth,
                             offset.y() / intrinsic->fy_px * depth, depth);
    corners[n] =
        AddVertex(pose.center + pose.rotation.transpose() * corner_in_cam,
                  DrawnKind::kCamera, drawing);
  }
  for (int n = 0; n < 4; ++n) {
    drawing->edges.push_back({center, corners[n]});
    drawing->edges.push_back({corners[n], corners[(n + 1) % 4]});
  }
}

}  // namespace

Result<SceneDrawing> DrawScene(const Scene& scene) {
  SceneDrawing drawing;
  for (const auto& [id, landmark] : scene.structure) {
    AddVertex(landmark.position, DrawnKind::kPoint, &drawing);
  }
  for (const auto& [id, line] : scene.line_structure) {
    const auto start = AddVertex(line.start, DrawnKind::kLine, &drawing);
    const auto end = AddVertex(line.end, DrawnKind::kLine, &drawing);
    drawing.edges.push_back({start, end});
  }
  const double depth = FrustumDepth(scene);
  for (const auto& [id, view] : scene.views) {
    if (const Pose* pose = scene.FindPose(id)) {
      DrawCamera(*pose, scene.FindIntrinsic(id), depth, &drawing);
    }
  }
  for (const SceneDrawing::Vertex& vertex : drawing.vertices) {
    if (!vertex.position.allFinite()) {
      return MakeError(ErrorCode::kInvalidScene,
                       "a position to draw is not finite");
    }
  }
  return drawing;
}

}  // namespace lowlap
