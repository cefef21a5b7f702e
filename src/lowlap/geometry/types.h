#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace lowlap {

using Vec2 = Eigen::Vector2d;
using Vec3 = Eigen::Vector3d;
using Vec4 = Eigen::Vector4d;
using Mat2 = Eigen::Matrix2d;
using Mat3 = Eigen::Matrix3d;
using Mat34 = Eigen::Matrix<double, 3, 4>;

inline constexpr double kPi = 3.14159265358979323846;
inline constexpr double DegFromRad(double rad) { return rad * (180.0 / kPi); }
inline constexpr double RadFromDeg(double deg) { return deg * (kPi / 180.0); }

}  // namespace lowlap
