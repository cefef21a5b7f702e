#include "lowlap/robust/internal/chi_square.h"

#include <cmath>

namespace lowlap {

double LogChiSquareTail(double value, int dimension) {
  const double half = 0.5 * value;
  // All terms over exp(-half).
  double sum = 1;
  int k = 2;
  if (dimension % 2 == 1) {
    // erfc(z) exp(z^2); its asymptotic series where erfc would underflow.
    constexpr double kLargestHalf = 600;
    sum = half < kLargestHalf
              ? std::erfc(std::sqrt(half)) * std::exp(half)
              : (1 - 1 / value) / std::sqrt(std::acos(-1.0) * half);
    k = 1;
  }
  for (; k < dimension; k += 2) {
    sum += half > 0
               ? std::exp(0.5 * k * std::log(half) - std::lgamma(0.5 * k + 1))
               : 0;
  }
  return std::log(sum) - half;
}

}  // namespace lowlap
