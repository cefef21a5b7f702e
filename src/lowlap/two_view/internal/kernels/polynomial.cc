#include "lowlap/two_view/internal/kernels/polynomial.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace lowlap {
namespace {

constexpr int kMaxDegree = 16;
using Coefficients = std::array<double, kMaxDegree + 1>;

struct Value {
  double value;
  double slope;
  double magnitude;  // sum of |terms|: the scale of the rounding error
};

Value Evaluate(const Coefficients& c, int degree, double z) {
  Value v{c[degree], 0, std::abs(c[degree])};
  const double size = std::abs(z);
  for (int i = degree - 1; i >= 0; --i) {
    v.slope = v.slope * z + v.value;
    v.value = v.value * z + c[i];
    v.magnitude = v.magnitude * size + std::abs(c[i]);
  }
  return v;
}

/// The root between a and b, where the polynomial has opposite signs.
double RootInBracket(const Coefficients& c, int degree, double a, double b,
                     bool rises) {
  double z = 0.5 * (a + b);
  for (int iteration = 0; iteration < 100; ++iteration) {
    const Value v = Evaluate(c, degree, z);
    if (v.value == 0) return z;
    ((v.value > 0) == rises ? b : a) = z;
    double next = z - v.value / v.slope;
    if (!(next > a && next < b)) next = 0.5 * (a + b);
    const double step = std::abs(next - z);
    z = next;
    if (step <= 1e-15 * std::max(1.0, std::abs(z))) break;
  }
  return z;
}

}  // namespace

std::vector<double> RealRootsInInterval(const std::vector<double>& coefficients,
                                        double low, double high) {
  int degree = static_cast<int>(coefficients.size()) - 1;
  while (degree > 0 && coefficients[degree] == 0) --degree;
  if (degree < 1 || degree > kMaxDegree) return {};

  // roots: those of the derivative of order `order`, from the linear one down.
  std::vector<double> roots;
  std::vector<double> critical;
  for (int order = degree - 1; order >= 0; --order) {
    const int d = degree - order;
    Coefficients c;
    for (int i = 0; i <= d; ++i) {
      c[i] = coefficients[i + order];
      for (int j = 1; j <= order; ++j) c[i] *= i + j;
    }
    critical.swap(roots);
    roots.clear();
    double a = low;
    Value at_a = Evaluate(c, d, a);
    for (std::size_t i = 0; i <= critical.size(); ++i) {
      const double b = i < critical.size() ? critical[i] : high;
      const Value at_b = Evaluate(c, d, b);
      if (at_a.value == 0) {
        roots.push_back(a);
      } else if (at_b.value != 0 && (at_a.value > 0) != (at_b.value > 0)) {
        roots.push_back(RootInBracket(c, d, a, b, at_b.value > 0));
      } else if (i < critical.size() &&
                 std::abs(at_b.value) <= 1e-12 * at_b.magnitude) {
        roots.push_back(b);
      }
      a = b;
      at_a = at_b;
    }
    if (at_a.value == 0) roots.push_back(a);
    roots.erase(std::unique(roots.begin(), roots.end()), roots.end());
  }
  return roots;
}

}  // namespace lowlap
