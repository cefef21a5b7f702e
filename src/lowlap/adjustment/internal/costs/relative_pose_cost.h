#pragma once

#include <Eigen/Geometry>

#include "lowlap/geometry/rotation.h"
#include "lowlap/geometry/types.h"

namespace lowlap::internal {

/// How far a pair of poses is from its measured relative pose, in standard
/// deviations (5):
///   r = W (w, B^T t / |t|),  exp([w]x) = (R2 R1^T) R_measured^T,
///   t = R2 (C1 - C2),  B = TangentBasis(measured direction),
/// W^T W the inverse of the measured covariance; w to first order (twice the
/// vector part of the quaternion). Parameter blocks: rotation and centre of
/// view 1, rotation and centre of view 2.
struct RelativePoseCost {
  Eigen::Quaterniond cam2_from_cam1;
  Eigen::Matrix<double, 3, 2> tangent_basis;
  Eigen::Matrix<double, 5, 5> sqrt_information;

  template <class T>
  bool operator()(const T* rotation1, const T* center1, const T* rotation2,
                  const T* center2, T* residual) const {
    using Vector3 = Eigen::Matrix<T, 3, 1>;
    const Eigen::Map<const Eigen::Quaternion<T>> q1(rotation1), q2(rotation2);
    const Eigen::Map<const Vector3> c1(center1), c2(center2);
    Eigen::Quaternion<T> error =
        q2 * q1.conjugate() * cam2_from_cam1.cast<T>().conjugate();
    if (error.w() < T(0)) error.coeffs() = -error.coeffs();
    const Vector3 t = q2 * Vector3(c1 - c2);
    const T length = t.norm();
    if (!(length > T(0))) return false;
    Eigen::Matrix<T, 5, 1> deviation;
    deviation.template head<3>() = T(2) * error.vec();
    deviation.template tail<2>() =
        tangent_basis.cast<T>().transpose() * t / length;
    Eigen::Map<Eigen::Matrix<T, 5, 1>> out(residual);
    out = sqrt_information.cast<T>() * deviation;
    return true;
  }
};

}  // namespace lowlap::internal
