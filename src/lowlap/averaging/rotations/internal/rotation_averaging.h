#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "lowlap/averaging/rotations/scene_rotations.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// A measured relative rotation: R_second = second_from_first R_first.
struct RotationMeasurement {
  std::size_t first = 0;
  std::size_t second = 0;
  Mat3 second_from_first = Mat3::Identity();
  double stddev_rad = 0.01;
  /// Low is trustworthy: orders the spanning trees of the start. The log10 NFA
  /// of the relative pose.
  double cost = 0;
  /// Keeps its full weight however large its residual is.
  bool trusted = false;
};

struct RotationAveragingResult {
  std::vector<Mat3> cam_from_world;   // identity at the first of a component
  std::vector<double> residuals_rad;  // per measurement
  /// Robust standard deviation of the right measurements in units of their
  /// stated ones; at least 1.
  double deviation_scale = 1;
  int num_iterations = 0;
};

/// Absolute rotations from relative ones:
///   min sum_e rho( |log(R_j^T R_ij R_i)| / sigma_e ).
///
/// Starts: composed spanning forests that prefer low cost, the support of
/// cycles (ScoreCycles), both, and both at random. From one of them, L1 goes
/// on, which a few wrong measurements do not move as long as their stated
/// deviations are honest; the branches of the others are turned to measurements
/// that fit better (TurnBranches). Each is followed by iteratively reweighted
/// Gauss-Newton on SO(3) (Chatterjee and Govindu 2013) with the Geman-McClure
/// weight, whose scale comes from the lower quartile of the residuals in its
/// own reach, and so tightens until wrong measurements are forgotten, and in
/// the end from their median. The solution of the least RobustCost is returned.
/// It is the same, to the byte, for any order of the measurements. Gauge: one
/// rotation of every connected component is the identity. A tree is reproduced
/// exactly.
///
/// Time, for each of 2 to max_starts starts: up to max_iterations solutions of
/// a graph Laplacian in the tangent space (SolveDifferences), next to which the
/// rest is little. Errors: kInvalidArgument (options, a measurement without two
/// views or a positive deviation), kNumerical, kCancelled.
Result<RotationAveragingResult> AverageRotations(
    std::size_t num_views, const std::vector<RotationMeasurement>& measurements,
    const RotationAveragingOptions& options = {},
    const RunContext& context = {});

}  // namespace lowlap
