#pragma once

#include <ceres/cost_function.h>

#include <Eigen/Core>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/internal/camera_set.h"

namespace lowlap {

/// What of an intrinsic is unknown: what refine_intrinsics says of it, and its
/// principal point if there is a principal_point_stddev.
IntrinsicRefinement RefinementOf(const AdjustmentOptions& options,
                                 const IntrinsicState& intrinsic);

/// The ways in which the parameters may move, as columns.
Eigen::MatrixXd FreeDirections(const IntrinsicRefinement& refinement,
                               const IntrinsicState& intrinsic);

/// How well the given principal point is known; 0 where nothing is said of it.
double PrincipalPointStddevPx(const AdjustmentOptions& options,
                              const IntrinsicState& intrinsic);

/// (principal point - given principal point) / stddev; one parameter block,
/// that of the intrinsic.
class PrincipalPointCost : public ceres::CostFunction {
 public:
  PrincipalPointCost(const IntrinsicState& intrinsic, double stddev_px);
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Vec2 given_px_;
  double stddev_px_;
};

}  // namespace lowlap
