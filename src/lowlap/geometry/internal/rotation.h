#pragma once

#include "lowlap/geometry/types.h"

namespace lowlap {

/// [v]x with [v]x w = v x w.
Mat3 CrossMatrix(const Vec3& v);

/// exp([w]x): the rotation by |w| radians about w (Rodrigues).
Mat3 RotationFromAngleAxis(const Vec3& angle_axis_rad);

/// The angle-axis vector w with exp([w]x) = R and |w| in [0, pi].
Vec3 AngleAxisFromRotation(const Mat3& rotation);

/// The angle of R_a^T R_b, in [0, pi].
double RotationAngleBetween(const Mat3& a, const Mat3& b);

/// The angle between two non-zero vectors, in [0, pi]; accurate near 0 and pi.
double AngleBetween(const Vec3& a, const Vec3& b);

/// The rotation closest to M in the Frobenius norm (SVD, det +1).
Mat3 NearestRotation(const Mat3& m);

/// Largest absolute entry of R R^T - I, and infinity if det R < 0 or an entry
/// is not finite.
double RotationDefect(const Mat3& m);

/// How far a given matrix may be from a rotation (RotationDefect), and a given
/// direction from unit length.
inline constexpr double kUnitTolerance = 1e-6;

/// Two unit vectors that complete the unit vector d to an orthonormal basis;
/// returned as columns.
Eigen::Matrix<double, 3, 2> TangentBasis(const Vec3& d);

}  // namespace lowlap
