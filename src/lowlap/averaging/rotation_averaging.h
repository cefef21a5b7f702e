#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// A measured relative rotation: R_second = second_from_first R_first.
struct RotationMeasurement {
  std::size_t first = 0;
  std::size_t second = 0;
  Mat3 second_from_first = Mat3::Identity();
  double stddev_rad = 0.01;
  /// Low is trustworthy: orders the spanning tree of the start.
  double cost = 0;
};

struct RotationAveragingOptions {
  int max_iterations = 100;
  double tolerance_rad = 1e-9;

  Status Validate() const;
};

struct RotationAveragingResult {
  std::vector<Mat3> cam_from_world;   // identity at the first of a component
  std::vector<double> residuals_rad;  // per measurement
  int num_iterations = 0;
};

/// Absolute rotations from relative ones:
///   min sum_e rho( |log(R_j^T R_ij R_i)| / sigma_e ).
///
/// Start: the minimum-cost spanning forest, composed. Then iteratively
/// reweighted Gauss-Newton on SO(3) (Chatterjee and Govindu 2013): first L1,
/// which a few wrong measurements do not move, then the Geman-McClure weight
/// with the scale of the residuals' median, which forgets them. Each step is a
/// graph Laplacian in the tangent space (SolveDifferences). Gauge: one
/// rotation of every connected component is the identity. A tree is
/// reproduced exactly.
Result<RotationAveragingResult> AverageRotations(
    std::size_t num_views, const std::vector<RotationMeasurement>& measurements,
    const RotationAveragingOptions& options = {});

}  // namespace lowlap
