#pragma once

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/geometry/rigid_transform.h"
#include "support/random_vectors.h"

namespace lowlap::testing {

inline Vec3 RandomVector(Random& random) {
  return {random.Gaussian(), random.Gaussian(), random.Gaussian()};
}

inline Mat3 RandomRotation(Random& random) {
  const Vec3 imaginary = GaussianVec3(random);
  return Eigen::Quaterniond(random.Gaussian(), imaginary.x(), imaginary.y(),
                            imaginary.z())
      .normalized()
      .toRotationMatrix();
}

inline RigidTransform RandomTransform(Random& random) {
  return {RandomRotation(random), RandomVector(random)};
}

/// A camera at `center` that looks at `target`.
inline RigidTransform LookAt(const Vec3& center, const Vec3& target) {
  const Vec3 z = (target - center).normalized();
  const Vec3 x = z.unitOrthogonal();
  Mat3 rotation;
  rotation << x.transpose(), z.cross(x).transpose(), z.transpose();
  return RigidTransform::FromRotationAndCenter(rotation, center);
}

}  // namespace lowlap::testing
