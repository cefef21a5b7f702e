#pragma once

#include <Eigen/Geometry>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// Rotation by a quaternion (u, w), stored x y z w as in Eigen, as a polynomial
/// of its four numbers (the rotation itself on the unit sphere):
///   M(q) v = v + 2 w (u x v) + 2 u x (u x v).
struct QuaternionRotation {
  Vec3 u;
  double w;

  explicit QuaternionRotation(const double* xyzw)
      : u(xyzw[0], xyzw[1], xyzw[2]), w(xyzw[3]) {}

  Mat3 Matrix() const {
    const Mat3 cross = CrossMatrix(u);
    return Mat3::Identity() + 2 * w * cross + 2 * cross * cross;
  }

  /// d (M v) / d (x, y, z, w).
  Eigen::Matrix<double, 3, 4> Jacobian(const Vec3& v) const {
    Eigen::Matrix<double, 3, 4> jacobian;
    jacobian.leftCols<3>() = -2 * w * CrossMatrix(v) +
                             2 * (u.dot(v) * Mat3::Identity() +
                                  u * v.transpose() - 2 * v * u.transpose());
    jacobian.col(3) = 2 * u.cross(v);
    return jacobian;
  }
};

}  // namespace lowlap
