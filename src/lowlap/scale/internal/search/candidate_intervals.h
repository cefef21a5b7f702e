#pragma once

#include <array>

#include "lowlap/robust/threshold_ladder.h"
#include "lowlap/scale/evidence/evidence.h"

namespace lowlap {

/// The error of one candidate at a few log ratios between which it is taken as
/// monotone: the ends of [low, high], its stationary points, and the
/// candidate's own ratio.
class CandidateProfile {
 public:
  CandidateProfile(const Evidence& evidence, int candidate, double low,
                   double high);

  /// Calls visit(begin, end) for every interval of [low, high] in which the
  /// error is below the threshold.
  template <class Visit>
  void VisitBelow(float threshold, const Visit& visit) const {
    bool inside = error_[0] < threshold;
    double begin = low_;
    for (int n = 1; n < size_; ++n) {
      if ((error_[n] < threshold) == inside) continue;
      const double crossing = Crossing(n - 1, threshold);
      if (inside) visit(begin, crossing);
      begin = crossing;
      inside = !inside;
    }
    if (inside) visit(begin, high_);
  }

 private:
  static constexpr int kMaxSize = Evidence::kMaxStationaryPoints + 3;

  // The log ratio where the error crosses the threshold between two of them.
  double Crossing(int n, float threshold) const;

  const Evidence& evidence_;
  int candidate_;
  double low_;
  double high_;
  int size_ = 0;
  std::array<double, kMaxSize> at_;  // tau
  std::array<float, kMaxSize> error_;
};

/// Calls visit(step, begin, end) for the intervals of log ratios in [low, high]
/// in which one candidate is an inlier, for the steps of the ladder from
/// `first_step` up to, and without, `end_step`, that `wanted(step)` tells.
template <class Wanted, class Visit>
void VisitInlierIntervals(const Evidence& evidence, int candidate, double low,
                          double high, int first_step, int end_step,
                          const Wanted& wanted, const Visit& visit) {
  while (first_step < end_step && !wanted(first_step)) ++first_step;
  if (first_step >= end_step) return;
  const CandidateProfile profile(evidence, candidate, low, high);
  for (int step = first_step; step < end_step; ++step) {
    if (!wanted(step)) continue;
    profile.VisitBelow(
        static_cast<float>(LadderThresholdPx(step)),
        [&](double begin, double end) { visit(step, begin, end); });
  }
}

}  // namespace lowlap
