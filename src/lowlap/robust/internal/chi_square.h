#pragma once

namespace lowlap {

/// Natural logarithm of the probability that a sum of `dimension` squared
/// standard normal variables exceeds `value`:
///   Q_1 = erfc(sqrt(x / 2)),  Q_2 = exp(-x / 2),
///   Q_{k+2} = Q_k + (x / 2)^{k/2} exp(-x / 2) / Gamma(k / 2 + 1).
/// Also where the probability itself is below the least double. dimension >= 1,
/// value >= 0.
double LogChiSquareTail(double value, int dimension);

}  // namespace lowlap
