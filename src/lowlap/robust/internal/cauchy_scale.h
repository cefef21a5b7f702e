#pragma once

#include <cmath>
#include <limits>

namespace lowlap {

/// The scale s of a Cauchy density ~ 1 / (1 + r^2 / s^2) that is cut off at
/// |r| = `reach` and whose |r| have the median m:
///   atan(m / s) = atan(reach / s) / 2,  hence  s = m / sqrt(1 - 2 m / reach).
/// Infinite where m is half the reach or more, as of a constant density.
inline double TruncatedCauchyScale(double median, double reach) {
  const double rest = 1 - 2 * median / reach;
  return rest > 0 ? median / std::sqrt(rest)
                  : std::numeric_limits<double>::infinity();
}

}  // namespace lowlap
