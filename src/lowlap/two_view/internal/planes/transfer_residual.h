#pragma once

#include <Eigen/Core>
#include <optional>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/two_view/internal/kernels/point_pairs.h"

namespace lowlap {

/// How far a match is from where a plane n . X = 1 of camera 1 puts it, in
/// pixels of a round error of variance 1: with H = R + t n^T,
///   h(x1) = (H x1)_12 / (H x1)_3,  d = f2 (x2_12 - h(x1)),
///   T = C2 + (f2 / f1)^2 h' C1 h'^T,
///   m = T^(-1/2) d,
/// C the shapes of the points' errors. To first order its component across the
/// epipolar line is SampsonResidual, which any depth of the point leaves as it
/// is; the component along the line is what the plane adds.
class TransferResidual {
 public:
  using Jacobian = Eigen::Matrix<double, 2, 8>;

  /// `pairs` must outlive the residual.
  TransferResidual(const RigidTransform& cam2_from_cam1,
                   const Vec3& plane_normal, const PointPairs& pairs);

  /// m, and, if asked for, its derivative by (w, d, n), w and d as in
  /// SampsonResidual, T as a constant. nullopt if the plane is behind camera 2.
  std::optional<Vec2> operator()(int pair, Jacobian* jacobian = nullptr) const;

  /// The component along the epipolar line, and, if asked for, its derivative
  /// by n, T and the line as constants. Infinite if the plane is behind
  /// camera 2, or where no depth moves the point.
  double Along(int pair, Vec3* by_normal = nullptr) const;

 private:
  struct Transfer {
    Vec3 turned = Vec3::Zero();  // R x1
    Vec2 place = Vec2::Zero();   // h
    double depth = 0;            // (H x1)_3
    Vec2 error_px = Vec2::Zero();
    Mat2 covariance = Mat2::Zero();  // T
  };
  std::optional<Transfer> TransferOf(int pair) const;

  const PointPairs& pairs_;
  RigidTransform cam2_from_cam1_;
  Vec3 normal_;
};

}  // namespace lowlap
