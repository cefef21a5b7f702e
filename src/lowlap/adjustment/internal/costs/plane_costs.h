#pragma once

#include <ceres/sized_cost_function.h>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// A plane as the solver sees it: n . (x - anchor) = offset, with n (3) on the
/// unit sphere and the offset (1); the anchor is fixed, near what is on it.
///
/// r = w (n . (X - anchor) - offset), the distance of a point from the plane in
/// units of the plane's thickness 1 / w. Blocks: X (3), plane (4).
class PointOnPlaneCost final : public ceres::SizedCostFunction<1, 3, 4> {
 public:
  PointOnPlaneCost(const Vec3& anchor, double weight)
      : anchor_(anchor), weight_(weight) {}
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Vec3 anchor_;
  double weight_;
};

/// The same of the two places p + low d and p + high d of a line. Blocks: line
/// (p and d, 6), plane (4).
class LineOnPlaneCost final : public ceres::SizedCostFunction<2, 6, 4> {
 public:
  LineOnPlaneCost(const Vec3& anchor, double weight, double low, double high)
      : anchor_(anchor), weight_(weight), along_{low, high} {}
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Vec3 anchor_;
  double weight_;
  double along_[2];
};

}  // namespace lowlap
