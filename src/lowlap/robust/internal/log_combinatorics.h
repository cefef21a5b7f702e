#pragma once

namespace lowlap {

/// log10 of n! (through lgamma, thread-safe, exact to double precision).
double Log10Factorial(double n);

/// log10 of C(n, k); -infinity for k < 0 or k > n.
double Log10Binomial(int n, int k);

}  // namespace lowlap
