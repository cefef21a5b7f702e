#pragma once

#include <vector>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// Matched points of two views, normalised (z = 1), and the focal lengths that
/// turn their residuals into pixels.
struct PointPairs {
  std::vector<Vec3> x1;
  std::vector<Vec3> x2;
  double focal1_px = 1;
  double focal2_px = 1;

  int size() const { return static_cast<int>(x1.size()); }
};

}  // namespace lowlap
