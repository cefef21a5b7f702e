#include "lowlap/geometry/internal/rotation.h"

#include <Eigen/SVD>
#include <cmath>
#include <limits>

namespace lowlap {

Mat3 CrossMatrix(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

Mat3 RotationFromAngleAxis(const Vec3& angle_axis_rad) {
  const double angle = angle_axis_rad.norm();
  // The next term of the series is below the rounding of 1.
  if (angle < 1e-12) return Mat3::Identity() + CrossMatrix(angle_axis_rad);
  return Eigen::AngleAxisd(angle, angle_axis_rad / angle).toRotationMatrix();
}

Vec3 AngleAxisFromRotation(const Mat3& rotation) {
  // The quaternion's vector part keeps small angles accurate, where the trace
  // does not.
  Eigen::Quaterniond q(rotation);
  if (q.w() < 0) q.coeffs() = -q.coeffs();
  const double sine = q.vec().norm();
  if (sine < 1e-300) return Vec3::Zero();
  return (2.0 * std::atan2(sine, q.w()) / sine) * q.vec();
}

double RotationAngleBetween(const Mat3& a, const Mat3& b) {
  return AngleAxisFromRotation(a.transpose() * b).norm();
}

double AngleBetween(const Vec3& a, const Vec3& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

Mat3 NearestRotation(const Mat3& m) {
  const Eigen::JacobiSVD<Mat3> svd(m,
                                   Eigen::ComputeFullU | Eigen::ComputeFullV);
  Vec3 signs(1, 1, 1);
  signs.z() =
      (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  return svd.matrixU() * signs.asDiagonal() * svd.matrixV().transpose();
}

double RotationDefect(const Mat3& m) {
  if (!m.allFinite() || m.determinant() < 0) {
    return std::numeric_limits<double>::infinity();
  }
  return (m * m.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff();
}

Eigen::Matrix<double, 3, 2> TangentBasis(const Vec3& d) {
  Eigen::Matrix<double, 3, 2> basis;
  basis.col(0) = d.unitOrthogonal();
  basis.col(1) = d.cross(basis.col(0));
  return basis;
}

}  // namespace lowlap
