#pragma once

#include <ceres/cost_function.h>

#include "lowlap/adjustment/internal/camera_set.h"

namespace lowlap {

/// The error of a point that is behind its camera, in place of a projection
/// that means nothing; the loss then treats the observation as an outlier.
inline constexpr double kBehindCameraErrorPx = 1e4;

/// r = W (project(M(q) (X - C)) - observed), in raw pixels (2), with W the
/// whitening of the observation.
///
/// Parameter blocks: rotation q (4), centre C (3), point X (3) and, if the
/// intrinsic is refined, its parameters (4 + number of coefficients).
class PointReprojectionCost final : public ceres::CostFunction {
 public:
  /// `intrinsic` must outlive the cost; its parameters are used where the
  /// intrinsic is not a block.
  PointReprojectionCost(const IntrinsicState* intrinsic, bool refine_intrinsic,
                        const Vec2& observed_px,
                        const Mat2& whitening = Mat2::Identity());
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  const IntrinsicState* intrinsic_;
  Vec2 observed_px_;
  Mat2 whitening_;
};

}  // namespace lowlap
