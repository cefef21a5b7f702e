#include "lowlap/report/internal/display_frame.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "lowlap/core/internal/median.h"

namespace lowlap {

DisplayFrame ChooseDisplayFrame(const Scene& scene) {
  std::vector<Vec3> shown;
  Vec3 up = Vec3::Zero();
  for (const auto& [id, pose] : scene.poses) {
    shown.push_back(pose.center);
    up -= pose.rotation.row(1).transpose();  // y points down in a camera
  }
  for (const auto& [id, landmark] : scene.structure) {
    shown.push_back(landmark.position);
  }
  for (const auto& [id, line] : scene.line_structure) {
    shown.emplace_back(0.5 * (line.start + line.end));
  }
  DisplayFrame frame;
  if (shown.empty()) return frame;
  for (int axis = 0; axis < 3; ++axis) {
    std::vector<double> values;
    values.reserve(shown.size());
    for (const Vec3& point : shown) values.push_back(point(axis));
    frame.center(axis) = Median(std::move(values));
  }
  std::vector<double> radii;
  radii.reserve(shown.size());
  for (const Vec3& point : shown) {
    radii.push_back((point - frame.center).norm());
  }
  std::sort(radii.begin(), radii.end());
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

}  // namespace lowlap
