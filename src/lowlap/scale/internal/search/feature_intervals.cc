#include "lowlap/scale/internal/search/feature_intervals.h"

#include <algorithm>
#include <cmath>

namespace lowlap {

FeatureProfile::FeatureProfile(const RatioSupport& support, FeatureKind kind,
                               int index, double low, double high)
    : support_(support), kind_(kind), index_(index), low_(low), high_(high) {
  const double tau_low = std::exp(low), tau_high = std::exp(high);
  at_[size_++] = tau_low;
  double taus[kMaxTurns + 1];
  int num_turns = support.Turns(kind, index, taus);
  taus[num_turns++] = std::exp(support.Ratios(kind)[index].log_ratio);
  for (int n = 0; n < num_turns; ++n) {
    if (taus[n] > tau_low && taus[n] < tau_high) at_[size_++] = taus[n];
  }
  std::sort(at_.begin() + 1, at_.begin() + size_);
  at_[size_++] = tau_high;
  for (int n = 0; n < size_; ++n) {
    error_px_[n] = support.ErrorOf(kind, index, at_[n]);
  }
}

double FeatureProfile::Crossing(int n, float threshold_px) const {
  // Single precision resolves no more.
  const double accuracy_px = 1e-5 * threshold_px;
  constexpr int kMaxIterations = 60;
  const auto difference = [&](float error_px) {
    // Errors behind a camera are huge: bounded, so that steps stay useful.
    return std::isfinite(error_px)
               ? std::min<double>(error_px, 100 * threshold_px) - threshold_px
               : 99.0 * threshold_px;
  };
  double a = at_[n], b = at_[n + 1];
  double fa = difference(error_px_[n]), fb = difference(error_px_[n + 1]);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    // Illinois; now and then halving, for errors far from linear.
    const double at =
        iteration % 4 == 3 ? 0.5 * (a + b) : (a * fb - b * fa) / (fb - fa);
    if (!(at > a && at < b)) break;
    const double f = difference(support_.ErrorOf(kind_, index_, at));
    if (std::abs(f) <= accuracy_px) return std::log(at);
    if ((f < 0) == (fa < 0)) {
      a = at;
      fa = f;
      fb *= 0.5;
    } else {
      b = at;
      fb = f;
      fa *= 0.5;
    }
  }
  return std::log(0.5 * (a + b));
}

}  // namespace lowlap
