#include "lowlap/averaging/rotation_averaging.h"

#include <algorithm>
#include <cmath>

#include "lowlap/averaging/difference_solver.h"
#include "lowlap/core/median.h"
#include "lowlap/geometry/rotation.h"

namespace lowlap {
namespace {

Vec3 Residual(const RotationMeasurement& m,
              const std::vector<Mat3>& rotations) {
  return AngleAxisFromRotation(rotations[m.second].transpose() *
                               m.second_from_first * rotations[m.first]);
}

std::vector<Mat3> ComposeAlongForest(
    std::size_t num_views, const std::vector<RotationMeasurement>& measurements,
    const std::vector<DifferenceEdge>& edges) {
  std::vector<double> costs;
  costs.reserve(measurements.size());
  for (const RotationMeasurement& m : measurements) costs.push_back(m.cost);
  std::vector<Mat3> rotations(num_views, Mat3::Identity());
  std::vector<bool> known(num_views, false);
  for (const std::size_t e : MinimumSpanningForest(num_views, edges, costs)) {
    const RotationMeasurement& m = measurements[e];
    // The walk starts every component at a view that stays the identity.
    if (!known[m.first] && !known[m.second]) {
      known[std::min(m.first, m.second)] = true;
    }
    if (known[m.first]) {
      rotations[m.second] = m.second_from_first * rotations[m.first];
      known[m.second] = true;
    } else {
      rotations[m.first] =
          m.second_from_first.transpose() * rotations[m.second];
      known[m.first] = true;
    }
  }
  return rotations;
}

}  // namespace

Status RotationAveragingOptions::Validate() const {
  if (max_iterations < 1 || !(tolerance_rad > 0)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "rotation averaging: iterations and tolerance must be "
                     "positive");
  }
  return {};
}

Result<RotationAveragingResult> AverageRotations(
    std::size_t num_views, const std::vector<RotationMeasurement>& measurements,
    const RotationAveragingOptions& options) {
  if (const Status valid = options.Validate(); !valid) {
    return tl::unexpected<Error>(valid.error());
  }
  std::vector<DifferenceEdge> edges;
  edges.reserve(measurements.size());
  for (const RotationMeasurement& m : measurements) {
    if (m.first >= num_views || m.second >= num_views || m.first == m.second ||
        !(m.stddev_rad > 0)) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "rotation averaging: a measurement needs two different "
                       "views and a positive standard deviation");
    }
    edges.push_back({m.first, m.second});
  }

  RotationAveragingResult result;
  std::vector<Mat3>& rotations = result.cam_from_world;
  rotations = ComposeAlongForest(num_views, measurements, edges);

  const Eigen::Index count = static_cast<Eigen::Index>(measurements.size());
  Eigen::VectorXd weights(count);
  Eigen::MatrixXd steps(count, 3);
  // L1 has done its work long before half of the iterations.
  const int num_l1_iterations = options.max_iterations / 2;
  bool robust_phase = false;
  for (int iteration = 0; iteration < options.max_iterations && count > 0;
       ++iteration) {
    std::vector<double> normalised(measurements.size());
    for (Eigen::Index e = 0; e < count; ++e) {
      const RotationMeasurement& m = measurements[e];
      steps.row(e) = Residual(m, rotations);
      normalised[e] = steps.row(e).norm() / m.stddev_rad;
    }
    const double scale = std::max(1.0, 1.4826 * Median(normalised));
    for (Eigen::Index e = 0; e < count; ++e) {
      const double r = normalised[e] / scale;
      const double information = 1.0 / std::pow(measurements[e].stddev_rad, 2);
      if (robust_phase) {
        constexpr double kReach = 3.0;
        const double x = r / kReach;
        weights(e) = information / std::pow(1 + x * x, 2);
      } else {
        weights(e) = information / std::max(r, 0.1);
      }
    }
    // exp(-w_j) E exp(w_i) ~ log E + w_i - w_j, so w_j - w_i = log E.
    const auto tangent = SolveDifferences(num_views, edges, weights, steps);
    if (!tangent) return tl::unexpected<Error>(tangent.error());
    double largest = 0;
    for (std::size_t n = 0; n < num_views; ++n) {
      const Vec3 w = tangent->row(static_cast<Eigen::Index>(n));
      largest = std::max(largest, w.norm());
      rotations[n] = rotations[n] * RotationFromAngleAxis(w);
    }
    result.num_iterations = iteration + 1;
    if (robust_phase && largest < options.tolerance_rad) break;
    if (largest < 1e3 * options.tolerance_rad ||
        iteration + 1 >= num_l1_iterations) {
      robust_phase = true;
    }
  }

  result.residuals_rad.reserve(measurements.size());
  for (const RotationMeasurement& m : measurements) {
    result.residuals_rad.push_back(Residual(m, rotations).norm());
  }
  return result;
}

}  // namespace lowlap
