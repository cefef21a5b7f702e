#pragma once

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// E = [t]x R, with x2^T E x1 = 0 for normalised points of the two views.
Mat3 EssentialFromPose(const RigidTransform& cam2_from_cam1);

/// Squared Sampson distance of the epipolar constraint, in the units of the
/// points (normalised: multiply by the focal length squared for pixels):
///   (x2^T E x1)^2 / (|(E x1)_12|^2 + |(E^T x2)_12|^2).
/// Points are homogeneous with z = 1. At both epipoles the value is 0/0; 0 is
/// returned, since such a match says nothing.
double SampsonSquared(const Mat3& essential, const Vec3& x1, const Vec3& x2);

}  // namespace lowlap
