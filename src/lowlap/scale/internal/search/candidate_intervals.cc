#include "lowlap/scale/internal/search/candidate_intervals.h"

#include <algorithm>
#include <cmath>

namespace lowlap {

CandidateProfile::CandidateProfile(const Evidence& evidence, int candidate,
                                   double low, double high)
    : evidence_(evidence), candidate_(candidate), low_(low), high_(high) {
  const double tau_low = std::exp(low), tau_high = std::exp(high);
  at_[size_++] = tau_low;
  double taus[Evidence::kMaxStationaryPoints + 1];
  int num_taus = evidence.StationaryPoints(candidate, taus);
  taus[num_taus++] = std::exp(evidence.ratios()[candidate].log_ratio);
  for (int n = 0; n < num_taus; ++n) {
    if (taus[n] > tau_low && taus[n] < tau_high) at_[size_++] = taus[n];
  }
  std::sort(at_.begin() + 1, at_.begin() + size_);
  at_[size_++] = tau_high;
  for (int n = 0; n < size_; ++n) {
    error_[n] = evidence.ErrorOf(at_[n], candidate);
  }
}

double CandidateProfile::Crossing(int n, float threshold) const {
  // Single precision resolves no more.
  const double accuracy = 1e-5 * threshold;
  constexpr int kMaxIterations = 60;
  const auto difference = [&](float error) {
    // Errors behind a camera are huge: bounded, so that steps stay useful.
    return std::isfinite(error)
               ? std::min<double>(error, 100 * threshold) - threshold
               : 99.0 * threshold;
  };
  double a = at_[n], b = at_[n + 1];
  double fa = difference(error_[n]), fb = difference(error_[n + 1]);
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    // Illinois; now and then halving, for errors far from linear.
    const double at =
        iteration % 4 == 3 ? 0.5 * (a + b) : (a * fb - b * fa) / (fb - fa);
    if (!(at > a && at < b)) break;
    const double f = difference(evidence_.ErrorOf(at, candidate_));
    if (std::abs(f) <= accuracy) return std::log(at);
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
