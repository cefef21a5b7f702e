#pragma once

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// The point of the line `on` that is closest to the line `to`; each line is
/// (point, direction). With n = d_on x d_to, D = p_to - p_on:
///   P = p_on + det[D, d_to, n] / |n|^2 d_on.
/// Parallel lines have none; the result is then far away, not NaN. `jacobian`,
/// by the twelve numbers, may be null.
Vec3 ClosestPoint(const double* on, const double* to,
                  Eigen::Matrix<double, 3, 12>* jacobian);

/// r = w f u . m / (|u| |m|),  u = P_ab - C,  m = (p_b - C) x d_b: how far the
/// meeting point, taken on line a, is seen beside line b by a camera at C that
/// sees b; the sine of an angle, times the focal length (1, pixels at the
/// image's centre). Blocks: C (3), line a (6), line b (6).
///
/// Unlike a difference of pixels it is bounded wherever the meeting point lies,
/// and it does not contain the camera's rotation.
class CoplanarTransferCost final : public ceres::SizedCostFunction<1, 3, 6, 6> {
 public:
  explicit CoplanarTransferCost(double scale_px) : scale_px_(scale_px) {}
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double scale_px_;  // w f
};

/// r = w f (u_ab / |u_ab| - u_ba / |u_ba|): the difference of the images of
/// P_ab and P_ba on the unit sphere about the camera, times the focal length
/// (3 numbers, of which 2 are independent). Blocks: C (3), line a, line b (6).
class CoplanarImageDistanceCost final
    : public ceres::SizedCostFunction<3, 3, 6, 6> {
 public:
  explicit CoplanarImageDistanceCost(double scale_px) : scale_px_(scale_px) {}
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double scale_px_;  // w f
};

}  // namespace lowlap
