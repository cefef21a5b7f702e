#include "lowlap/scene/internal/intrinsic_shift.h"

#include <algorithm>
#include <optional>

namespace lowlap {

double IntrinsicShiftPx(const Intrinsic& from, const Intrinsic& to) {
  double largest_px = 0;
  for (const double x : {0.0, 0.5, 1.0}) {
    for (const double y : {0.0, 0.5, 1.0}) {
      const Vec2 pixel(x * to.width_px, y * to.height_px);
      const std::optional<Vec3> ray = from.Bearing(pixel);
      if (ray) {
        largest_px = std::max(largest_px, (to.Project(*ray) - pixel).norm());
      }
    }
  }
  return largest_px;
}

}  // namespace lowlap
