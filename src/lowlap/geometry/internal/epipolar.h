#pragma once

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// E = [t]x R, with x2^T E x1 = 0 for normalised points of the two views.
inline Mat3 EssentialFromPose(const RigidTransform& cam2_from_cam1) {
  return CrossMatrix(cam2_from_cam1.translation) * cam2_from_cam1.rotation;
}

/// Squared Sampson distance of the epipolar constraint, in the units of the
/// points (normalised: multiply by the focal length squared for pixels):
///   (x2^T E x1)^2 / (|(E x1)_12|^2 + |(E^T x2)_12|^2).
/// Points are homogeneous with z = 1. At both epipoles the value is 0/0; 0 is
/// returned, since such a match says nothing.
inline double SampsonSquared(const Mat3& essential, const Vec3& x1,
                             const Vec3& x2) {
  const Vec3 line2 = essential * x1;
  const Vec3 line1 = essential.transpose() * x2;
  const double gradient =
      line2.head<2>().squaredNorm() + line1.head<2>().squaredNorm();
  if (!(gradient > 0)) return 0;
  const double algebraic = x2.dot(line2);
  return algebraic * algebraic / gradient;
}

}  // namespace lowlap
