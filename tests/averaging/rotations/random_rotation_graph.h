#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "averaging/random_problem.h"
#include "lowlap/averaging/rotations/internal/rotation_averaging.h"

namespace lowlap {

/// A view graph with measured rotations, some of which are false.
struct RotationGraph {
  std::vector<Mat3> truth;
  std::vector<RotationMeasurement> measurements;
  std::vector<bool> is_false;

  void Add(std::size_t first, std::size_t second, const Vec3& error,
           bool false_edge) {
    RotationMeasurement m;
    m.first = first;
    m.second = second;
    m.stddev_rad = 0.003;
    m.second_from_first =
        RotationFromAngleAxis(error) * truth[second] * truth[first].transpose();
    measurements.push_back(m);
    is_false.push_back(false_edge);
  }

  /// Largest rotation error over the views, after the best common turn is taken
  /// to be that of view `anchor`.
  double WorstErrorRad(const std::vector<Mat3>& solved,
                       std::size_t anchor = 0) const {
    double worst = 0;
    for (std::size_t n = 0; n < truth.size(); ++n) {
      worst = std::max(
          worst, RotationAngleBetween(
                     truth[n] * truth[anchor].transpose() * solved[anchor],
                     solved[n]));
    }
    return worst;
  }
};

/// `num_views` views on a loop, each joined to the next `window` ones, errors
/// of 0.003 radians per axis; of the edges beyond the first neighbours a share
/// is false, by angles up to `false_rad` about any axis.
inline RotationGraph MakeRotationGraph(std::size_t num_views,
                                       std::size_t window, double false_share,
                                       double false_rad, std::uint64_t seed) {
  RotationGraph graph;
  Random random(seed);
  for (std::size_t n = 0; n < num_views; ++n) {
    graph.truth.push_back(RandomRotation(&random));
  }
  for (std::size_t a = 0; a < num_views; ++a) {
    for (std::size_t step = 1; step <= window; ++step) {
      const std::size_t b = (a + step) % num_views;
      const bool is_false = random.Uniform() < false_share;
      const Vec3 noise = GaussianVector(&random, 0.003);
      graph.Add(a, b, is_false ? RandomVector(&random, false_rad) : noise,
                is_false);
      // False matches tend to be fewer: evidence tells something, not all.
      const double evidence = random.Uniform(is_false ? 2 : 10, 100);
      graph.measurements.back().cost = -evidence;
    }
  }
  return graph;
}

/// The graph as a scene; evidence from the costs, deviations as stated.
inline Scene ToScene(const RotationGraph& graph) {
  Scene scene;
  for (std::size_t n = 0; n < graph.truth.size(); ++n) {
    View view;
    view.filename = std::to_string(n);
    scene.views[static_cast<ViewId>(n)] = view;
  }
  for (const RotationMeasurement& m : graph.measurements) {
    RelativePose pose;
    pose.views = {static_cast<ViewId>(std::min(m.first, m.second)),
                  static_cast<ViewId>(std::max(m.first, m.second))};
    pose.rotation = m.first < m.second ? m.second_from_first
                                       : Mat3(m.second_from_first.transpose());
    pose.log10_nfa = m.cost;
    pose.covariance =
        Eigen::Matrix<double, 5, 5>::Identity() * (m.stddev_rad * m.stddev_rad);
    scene.relative_poses[pose.views] = pose;
  }
  return scene;
}

}  // namespace lowlap
