#pragma once

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/types.h"

namespace lowlap::testing {

// Vectors of random coordinates, the last one drawn first. With a draw in each
// argument of a constructor, their order would be the compiler's, and the
// test's scene with it.

inline Vec2 GaussianVec2(Random& random, double stddev = 1) {
  const double y = random.Gaussian(stddev);
  return {random.Gaussian(stddev), y};
}

inline Vec3 GaussianVec3(Random& random, double stddev = 1) {
  const double z = random.Gaussian(stddev);
  const Vec2 rest = GaussianVec2(random, stddev);
  return {rest.x(), rest.y(), z};
}

inline Vec2 UniformVec2(Random& random, const Vec2& low, const Vec2& high) {
  const double y = random.Uniform(low.y(), high.y());
  return {random.Uniform(low.x(), high.x()), y};
}

inline Vec3 UniformVec3(Random& random, const Vec3& low, const Vec3& high) {
  const double z = random.Uniform(low.z(), high.z());
  const Vec2 rest = UniformVec2(random, low.head<2>(), high.head<2>());
  return {rest.x(), rest.y(), z};
}

}  // namespace lowlap::testing
