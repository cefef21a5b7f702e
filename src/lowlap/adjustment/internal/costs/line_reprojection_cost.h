#pragma once

#include <ceres/cost_function.h>

#include "lowlap/adjustment/internal/costs/segment_rays.h"

namespace lowlap {

/// A line as the solver sees it: a point p and a unit direction d, six numbers
/// on ceres::LineManifold<3>, which has four degrees of freedom. p is kept near
/// the observed segments, where p and d are best conditioned.
using LineParameters = Eigen::Matrix<double, 6, 1>;

/// r_i = w n . e_i / | J_i^T n |,  n = M(q) ((p - C) x d): the distances of a
/// segment's two end points from the image of the line, in pixels (2).
///
/// Parameter blocks: rotation q (4), centre C (3), line (6) and, if the
/// intrinsic is refined, its parameters: the rays then move with them to first
/// order about the values at construction. `weight` puts the residuals of
/// segments of different quality on one scale.
class LineReprojectionCost final : public ceres::CostFunction {
 public:
  LineReprojectionCost(const SegmentRays& segment, double weight,
                       const IntrinsicState& intrinsic, bool refine_intrinsic);
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  SegmentRays segment_;
  double weight_;
  int intrinsic_count_;
  IntrinsicParameters linearised_at_;
};

}  // namespace lowlap
