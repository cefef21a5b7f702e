#pragma once

namespace lowlap {

/// log10 of n! (through lgamma, thread-safe, exact to double precision).
double Log10Factorial(double n);

/// log10 of C(n, k); -infinity for k < 0 or k > n.
double Log10Binomial(int n, int k);

/// log10 of the chance that at least k of n independent events of chance p
/// happen, 0 < p < 1; 0 for k <= 0, -infinity for k > n.
double Log10BinomialTail(int n, int k, double p);

}  // namespace lowlap
