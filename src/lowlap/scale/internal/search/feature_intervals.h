#pragma once

#include <array>

#include "lowlap/scale/internal/criterion/ratio_support.h"

namespace lowlap {

/// The error of one feature at a few ratios between which it is taken as
/// monotone: the ends of [low, high], where the sides of the error turn, and
/// the feature's own ratio.
class FeatureProfile {
 public:
  FeatureProfile(const RatioSupport& support, FeatureKind kind, int index,
                 double low, double high);

  /// Calls visit(begin, end) for every interval of [low, high] in which the
  /// error is below the threshold.
  template <class Visit>
  void VisitBelow(float threshold_px, const Visit& visit) const {
    bool inside = error_px_[0] < threshold_px;
    double begin = low_;
    for (int n = 1; n < size_; ++n) {
      if ((error_px_[n] < threshold_px) == inside) continue;
      const double crossing = Crossing(n - 1, threshold_px);
      if (inside) visit(begin, crossing);
      begin = crossing;
      inside = !inside;
    }
    if (inside) visit(begin, high_);
  }

 private:
  static constexpr int kMaxSize = kMaxTurns + 3;

  // The log ratio where the error crosses the threshold between two of them.
  double Crossing(int n, float threshold_px) const;

  const RatioSupport& support_;
  FeatureKind kind_;
  int index_;
  double low_;
  double high_;
  int size_ = 0;
  std::array<double, kMaxSize> at_;  // tau
  std::array<float, kMaxSize> error_px_;
};

/// Calls visit(step, begin, end) for the intervals of log ratios in [low, high]
/// in which one feature is an inlier, for the steps of the ladder from
/// `first_step` up to, and without, `end_step`, that `wanted(step)` tells.
template <class Wanted, class Visit>
void VisitInlierIntervals(const RatioSupport& support, FeatureKind kind,
                          int index, double low, double high, int first_step,
                          int end_step, const Wanted& wanted,
                          const Visit& visit) {
  while (first_step < end_step && !wanted(first_step)) ++first_step;
  if (first_step >= end_step) return;
  const FeatureProfile profile(support, kind, index, low, high);
  for (int step = first_step; step < end_step; ++step) {
    if (!wanted(step)) continue;
    profile.VisitBelow(
        static_cast<float>(LadderThresholdPx(step)),
        [&](double begin, double end) { visit(step, begin, end); });
  }
}

}  // namespace lowlap
