#include "lowlap/robust/internal/log_combinatorics.h"

#include <cmath>
#include <limits>

namespace lowlap {
namespace {

constexpr double kLog10E = 0.43429448190325182765;

}  // namespace

double Log10Factorial(double n) {
  int sign = 0;  // lgamma would write to the global signgam
  return kLog10E * ::lgamma_r(n + 1.0, &sign);
}

double Log10Binomial(int n, int k) {
  if (k < 0 || k > n) return -std::numeric_limits<double>::infinity();
  return Log10Factorial(n) - Log10Factorial(k) - Log10Factorial(n - k);
}

}  // namespace lowlap
