#pragma once

#include <ceres/sized_cost_function.h>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// A plane as the solver sees it: n . (x - anchor) = offset, with n (3) on the
/// unit sphere and the offset (1); the anchor is fixed, near what is on it.
///
/// A place X that a camera at C sees is off the plane by
///   r = w (n . (X - anchor) - offset) D / |X - C|,
/// 1 / w the plane's thickness and D the distance |X - C| at which it was
/// estimated: an angle in the end. In units of the world alone, what only
/// planes hold would shrink until it is flat.
///
/// Evaluation fails at X = C.
class PlaceOnPlane {
 public:
  PlaceOnPlane(const Vec3& anchor, double weight, double distance)
      : anchor_(anchor), weight_(weight), distance_(distance) {}

  /// r, and its derivatives by X, the plane (3 + 1) and C.
  struct Residual {
    double value = 0;
    Eigen::RowVector3d by_place, by_center;
    Eigen::RowVector4d by_plane;
  };
  bool Evaluate(const Vec3& place, const double* plane, const double* center,
                Residual* residual) const;

 private:
  Vec3 anchor_;
  double weight_;
  double distance_;
};

/// Of a point. Blocks: X (3), plane (4), centre (3).
class PointOnPlaneCost final : public ceres::SizedCostFunction<1, 3, 4, 3> {
 public:
  explicit PointOnPlaneCost(const PlaceOnPlane& place) : place_(place) {}
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  PlaceOnPlane place_;
};

/// Of the two places p + low d and p + high d of a line. Blocks: line (p and d,
/// 6), plane (4), centre (3).
class LineOnPlaneCost final : public ceres::SizedCostFunction<2, 6, 4, 3> {
 public:
  LineOnPlaneCost(const PlaceOnPlane& at_low, const PlaceOnPlane& at_high,
                  double low, double high)
      : places_{at_low, at_high}, along_{low, high} {}
  bool Evaluate(const double* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  PlaceOnPlane places_[2];
  double along_[2];
};

}  // namespace lowlap
