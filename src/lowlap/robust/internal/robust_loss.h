#pragma once

#include <cmath>

namespace lowlap {

/// Geman and McClure's loss c^2 x^2 / (1 + x^2) of a residual r, x = r / c, in
/// units of c^2: quadratic well within the reach c, and bounded beyond. The
/// weight of reweighted least squares is rho'(r) / (2 r).
inline double GemanMcClureLoss(double x_squared) {
  return x_squared / (1 + x_squared);
}
inline double GemanMcClureWeight(double x_squared) {
  const double root = 1 + x_squared;
  return 1 / (root * root);
}

/// Huber's loss of a residual of the given size: r^2 / 2 up to `turn`, linear
/// beyond. The weight is rho'(r) / r.
inline double HuberLoss(double size, double turn) {
  return size <= turn ? 0.5 * size * size : turn * (size - 0.5 * turn);
}
inline double HuberWeight(double size, double turn) {
  return size <= turn ? 1 : turn / size;
}

}  // namespace lowlap
