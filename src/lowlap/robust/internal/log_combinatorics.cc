#include "lowlap/robust/internal/log_combinatorics.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

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

double Log10BinomialTail(int n, int k, double p) {
  if (k <= 0) return 0;
  double greatest = -std::numeric_limits<double>::infinity();
  if (k > n) return greatest;
  std::vector<double> terms;
  for (int m = k; m <= n; ++m) {
    terms.push_back(Log10Binomial(n, m) + m * std::log10(p) +
                    (n - m) * std::log10(1 - p));
    greatest = std::max(greatest, terms.back());
  }
  double sum = 0;
  for (const double term : terms) sum += std::pow(10.0, term - greatest);
  return std::min(0.0, greatest + std::log10(sum));
}

}  // namespace lowlap
