#pragma once

#include <vector>

namespace lowlap {

/// The real roots in [low, high] of coefficients[0] + coefficients[1] z + ...,
/// ascending. The roots of the derivative, found first, split the interval into
/// pieces on which the polynomial is monotone; each piece with a change of sign
/// holds one root (bisection-guarded Newton). A critical point at which the
/// polynomial is zero to rounding counts as a (double) root.
std::vector<double> RealRootsInInterval(const std::vector<double>& coefficients,
                                        double low, double high);

}  // namespace lowlap
