#pragma once

#include <vector>

namespace lowlap {

/// How dense the log ratios of one kind of feature are, as unrelated ones: the
/// ratios smoothed by a logistic of scale kSpread, so that features that agree
/// do not make a peak of their own. Tabulated on a grid.
class RatioDensity {
 public:
  /// In log tau: half of the logistic lies within 32 %.
  static constexpr double kSpread = 0.25;

  RatioDensity() = default;
  /// Of sorted log ratios.
  explicit RatioDensity(const std::vector<double>& sorted);

  /// log10 of the density at a log ratio over the mean density at the smoothed
  /// ratios. Not below that of half the mean, since little is known of the
  /// tails; 0 without ratios.
  double Log10Relative(double log_ratio) const;
  /// Its least value between two log ratios.
  double LeastLog10Relative(double low, double high) const;

 private:
  double low_ = 0;
  std::vector<double> log10_relative_;
};

}  // namespace lowlap
