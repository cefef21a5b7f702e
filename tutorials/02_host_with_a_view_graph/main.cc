// Tutorial 2: a program with a view graph in memory calls the estimator.
//
// The host has its own types for views and relative poses, here filled from a
// little world of its own: four cameras on a bend before two walls. No point
// and no line is seen by three of them. Its translation step is the part
// between the two marks; one header of lowlap is all it needs.
//
//   cmake -S tutorials/02_host_with_a_view_graph -B build/tutorial02
//   cmake --build build/tutorial02 && build/tutorial02/host_with_a_view_graph
#include <lowlap/pipeline/translation_scale_estimator.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <random>
#include <vector>

namespace host {

struct View {
  int id;
  Eigen::Matrix3d calibration;  // pixels
  Eigen::Matrix2Xd points;      // pixels, one column each
  Eigen::Matrix4Xd segments;    // x1 y1 x2 y2
};

struct RelativePose {
  int first, second;
  Eigen::Matrix3d rotation;     // x_second = rotation x_first + s translation
  Eigen::Vector3d translation;  // of unknown length s
  Eigen::Matrix2Xi point_matches, line_matches;  // columns of the two views
};

struct ViewGraph {
  std::vector<View> views;
  std::vector<RelativePose> relative_poses;
  std::vector<Eigen::Vector3d> true_centers;  // to compare with
};

constexpr int kWidth = 1600, kHeight = 1200;

// Points and segments on the walls z = 6 and z = 6 + x / 2, each seen by the
// two cameras of one relative pose only.
ViewGraph MakeGraph() {
  ViewGraph graph;
  graph.true_centers = {
      {-2, 0, 0}, {-0.9, 0.1, 0.4}, {1.0, 0, 0}, {1.6, 0, -1}};
  std::vector<Eigen::Matrix3d> rotations;
  Eigen::Matrix3d calibration;
  calibration << 1200, 0, 800, 0, 1205, 600, 0, 0, 1;
  for (int n = 0; n < 4; ++n) {
    rotations.push_back(
        Eigen::AngleAxisd(0.12 * n - 0.2, Eigen::Vector3d::UnitY())
            .toRotationMatrix());
    graph.views.push_back({n, calibration, {}, {}});
  }
  const auto pixel = [&](int view, const Eigen::Vector3d& point) {
    const Eigen::Vector3d in_camera =
        calibration * (rotations[view] * (point - graph.true_centers[view]));
    return Eigen::Vector2d(in_camera.hnormalized());
  };
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  const auto on_wall = [&](int wall) {
    const double x = 3 * uniform(random), y = 2 * uniform(random);
    return Eigen::Vector3d(x, y, wall == 0 ? 6 : 6 + x / 2);
  };
  for (int first = 0; first < 3; ++first) {
    View& a = graph.views[first];
    View& b = graph.views[first + 1];
    constexpr int kPoints = 20, kSegments = 60;
    RelativePose pose;
    pose.first = first;
    pose.second = first + 1;
    pose.rotation = rotations[first + 1] * rotations[first].transpose();
    pose.translation = rotations[first + 1] * (graph.true_centers[first] -
                                               graph.true_centers[first + 1]);
    pose.point_matches.resize(2, kPoints);
    pose.line_matches.resize(2, kSegments);
    const auto grow = [](auto& features, int columns) {
      const auto old = static_cast<int>(features.cols());
      features.conservativeResize(Eigen::NoChange, old + columns);
      return old;
    };
    const int points_a = grow(a.points, kPoints);
    const int points_b = grow(b.points, kPoints);
    for (int n = 0; n < kPoints; ++n) {
      const Eigen::Vector3d point = on_wall(n % 2);
      a.points.col(points_a + n) = pixel(first, point);
      b.points.col(points_b + n) = pixel(first + 1, point);
      pose.point_matches.col(n) << points_a + n, points_b + n;
    }
    const int segments_a = grow(a.segments, kSegments);
    const int segments_b = grow(b.segments, kSegments);
    for (int n = 0; n < kSegments; ++n) {
      const Eigen::Vector3d start = on_wall(n % 2), end = on_wall(n % 2);
      a.segments.col(segments_a + n) << pixel(first, start), pixel(first, end);
      b.segments.col(segments_b + n) << pixel(first + 1, start),
          pixel(first + 1, end);
      pose.line_matches.col(n) << segments_a + n, segments_b + n;
    }
    graph.relative_poses.push_back(pose);
  }
  return graph;
}

}  // namespace host

int main() {
  const host::ViewGraph graph = host::MakeGraph();

  // ---- the translation step: begin ----
  lowlap::TranslationScaleEstimator estimator;
  for (const host::View& view : graph.views) {
    estimator.AddView(view.id, view.calibration, host::kWidth, host::kHeight,
                      view.points, view.segments);
  }
  for (const host::RelativePose& pose : graph.relative_poses) {
    estimator.AddRelativePose(pose.first, pose.second, pose.rotation,
                              pose.translation, pose.point_matches,
                              pose.line_matches);
  }
  const auto estimate = estimator.Estimate();
  if (!estimate) return std::puts(estimate.error().ToString().c_str()), 1;
  // ---- the translation step: end ----

  bool right = estimate->poses.size() == graph.views.size();
  for (const lowlap::ScaleRatio& ratio : estimate->ratios) {
    const auto length = [&](lowlap::ViewId a, lowlap::ViewId b) {
      return (graph.true_centers[a.value()] - graph.true_centers[b.value()])
          .norm();
    };
    const double truth = length(ratio.views.middle, ratio.views.last) /
                         length(ratio.views.first, ratio.views.middle);
    std::printf("lengths %u-%u : %u-%u  ratio %.4f, true %.4f: %s\n",
                ratio.views.middle.value(), ratio.views.last.value(),
                ratio.views.first.value(), ratio.views.middle.value(),
                std::exp(ratio.log_ratio), truth,
                lowlap::RatioVerdictName(ratio.verdict));
    right = right && std::abs(ratio.log_ratio - std::log(truth)) < 0.01;
  }
  for (const auto& [view, pose] : estimate->poses) {
    std::printf("centre of view %u: %8.4f %8.4f %8.4f\n", view.value(),
                pose.center.x(), pose.center.y(), pose.center.z());
  }
  return right ? 0 : 1;
}
