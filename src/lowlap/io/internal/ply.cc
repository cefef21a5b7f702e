#include "lowlap/io/internal/ply.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "lowlap/core/internal/median.h"
#include "lowlap/io/internal/byte_archive.h"

namespace lowlap {
namespace {

using Color = std::array<std::uint8_t, 3>;
constexpr Color kPointColor = {255, 255, 255};
constexpr Color kLineColor = {255, 160, 0};
constexpr Color kCameraColor = {0, 200, 0};

// Vertices and edges in file order, already encoded.
struct Drawing {
  std::uint32_t vertex_count = 0, edge_count = 0;
  std::string vertices, edges;
  bool is_finite = true;

  std::uint32_t AddVertex(const Vec3& position, const Color& color) {
    ByteWriter writer(vertices);
    writer.Reals(position.data(), 3);
    for (const std::uint8_t channel : color) writer.Integer(channel);
    is_finite = is_finite && position.allFinite();
    return vertex_count++;
  }

  void AddEdge(std::uint32_t a, std::uint32_t b, const Color& color) {
    ByteWriter writer(edges);
    writer.Integer(a);
    writer.Integer(b);
    for (const std::uint8_t channel : color) writer.Integer(channel);
    ++edge_count;
  }
};

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

void DrawCamera(const Pose& pose, const Intrinsic* intrinsic, double depth,
                Drawing& drawing) {
  const std::uint32_t center = drawing.AddVertex(pose.center, kCameraColor);
  if (!intrinsic || intrinsic->model == CameraModel::kSpherical) return;
  std::array<std::uint32_t, 4> corners;
  for (int n = 0; n < 4; ++n) {
    // Round the image: (0, 0), (w, 0), (w, h), (0, h).
    const Vec2 pixel(n == 1 || n == 2 ? intrinsic->width_px : 0,
                     n >= 2 ? intrinsic->height_px : 0);
    const Vec2 offset = pixel - intrinsic->principal_point_px;
    const Vec3 corner_in_cam(offset.x() / intrinsic->fx_px * depth,
                             offset.y() / intrinsic->fy_px * depth, depth);
    corners[n] = drawing.AddVertex(
        pose.center + pose.rotation.transpose() * corner_in_cam, kCameraColor);
  }
  for (int n = 0; n < 4; ++n) {
    drawing.AddEdge(center, corners[n], kCameraColor);
    drawing.AddEdge(corners[n], corners[(n + 1) % 4], kCameraColor);
  }
}

Drawing Draw(const Scene& scene) {
  Drawing drawing;
  for (const auto& [id, landmark] : scene.structure) {
    drawing.AddVertex(landmark.position, kPointColor);
  }
  for (const auto& [id, line] : scene.line_structure) {
    const std::uint32_t start = drawing.AddVertex(line.start, kLineColor);
    const std::uint32_t end = drawing.AddVertex(line.end, kLineColor);
    drawing.AddEdge(start, end, kLineColor);
  }
  const double depth = FrustumDepth(scene);
  for (const auto& [id, view] : scene.views) {
    if (const Pose* pose = scene.FindPose(id)) {
      DrawCamera(*pose, scene.FindIntrinsic(id), depth, drawing);
    }
  }
  return drawing;
}

}  // namespace

Result<std::string> FormatPly(const Scene& scene) {
  const Drawing drawing = Draw(scene);
  if (!drawing.is_finite) {
    return MakeError(ErrorCode::kInvalidScene,
                     "a position to draw is not finite");
  }
  return "ply\nformat binary_little_endian 1.0\ncomment lowlap scene\n"
         "element vertex " +
         std::to_string(drawing.vertex_count) +
         "\nproperty double x\nproperty double y\nproperty double z\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\n"
         "element edge " +
         std::to_string(drawing.edge_count) +
         "\nproperty int vertex1\nproperty int vertex2\n"
         "property uchar red\nproperty uchar green\nproperty uchar blue\n"
         "end_header\n" +
         drawing.vertices + drawing.edges;
}

}  // namespace lowlap
