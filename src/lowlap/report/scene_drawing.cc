#include "lowlap/report/internal/scene_drawing.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/median.h"

namespace lowlap {
namespace {

// World -> drawing.
struct Frame {
  Mat3 rotation = Mat3::Identity();
  Vec3 center = Vec3::Zero();
  double scale = 1;

  Vec3 operator()(const Vec3& point_in_world) const {
    return rotation * (point_in_world - center) * scale;
  }
};

Frame ChooseFrame(const Scene& scene) {
  std::vector<Vec3> drawn;
  Vec3 up = Vec3::Zero();
  for (const auto& [id, pose] : scene.poses) {
    drawn.push_back(pose.center);
    up -= pose.rotation.row(1).transpose();  // y points down in a camera
  }
  for (const auto& [id, landmark] : scene.structure) {
    drawn.push_back(landmark.position);
  }
  for (const auto& [id, line] : scene.line_structure) {
    drawn.push_back(0.5 * (line.start + line.end));
  }
  Frame frame;
  if (drawn.empty()) return frame;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    values.reserve(drawn.size());
    for (const Vec3& point : drawn) values.push_back(point(axis));
    frame.center(axis) = Median(std::move(values));
  }
  std::vector<double> radii;
  radii.reserve(drawn.size());
  for (const Vec3& point : drawn)
    radii.push_back((point - frame.center).norm());
  std::sort(radii.begin(), radii.end());
  // Every camera is shown, however far the points are.
  double radius = radii[radii.size() * 9 / 10];
  for (const auto& [id, pose] : scene.poses) {
    radius = std::max(radius, (pose.center - frame.center).norm());
  }
  if (radius > 0) frame.scale = 1.0 / radius;
  if (up.norm() > 1e-9) {
    frame.rotation = Eigen::Quaterniond::FromTwoVectors(up, Vec3::UnitZ())
                         .toRotationMatrix();
  }
  return frame;
}

void Append(const Vec3& point, std::string* list) {
  *list += Format("%.4g,%.4g,%.4g,", point.x(), point.y(), point.z());
}

}  // namespace

std::string DrawingData(const Scene& scene, std::size_t max_points) {
  constexpr double kFrustumDepth = 0.05;
  const Frame frame = ChooseFrame(scene);
  std::string points, segments, cameras;
  const std::size_t stride =
      std::max<std::size_t>(1, (scene.structure.size() + max_points - 1) /
                                   std::max<std::size_t>(1, max_points));
  std::size_t n = 0;
  for (const auto& [id, landmark] : scene.structure) {
    if (n++ % stride == 0) Append(frame(landmark.position), &points);
  }
  for (const auto& [id, line] : scene.line_structure) {
    Append(frame(line.start), &segments);
    Append(frame(line.end), &segments);
  }
  for (const auto& [view_id, view] : scene.views) {
    const Pose* pose = scene.FindPose(view_id);
    const Intrinsic* intrinsic = scene.FindIntrinsic(view_id);
    if (pose == nullptr) continue;
    const Vec3 center = frame(pose->center);
    Append(center, &cameras);
    const double half_width =
        intrinsic == nullptr ? 0.5
                             : 0.5 * view.width_px / intrinsic->MeanFocalPx();
    const double half_height =
        intrinsic == nullptr ? 0.4
                             : 0.5 * view.height_px / intrinsic->MeanFocalPx();
    for (const auto& [x, y] : {std::pair(-1, -1), std::pair(1, -1),
                               std::pair(1, 1), std::pair(-1, 1)}) {
      const Vec3 corner_in_cam(x * half_width, y * half_height, 1.0);
      Append(center +
                 kFrustumDepth * (frame.rotation *
                                  (pose->rotation.transpose() * corner_in_cam)),
             &cameras);
    }
  }
  return "{points:[" + points + "],segments:[" + segments + "],cameras:[" +
         cameras + "]}";
}

}  // namespace lowlap
