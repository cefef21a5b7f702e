#pragma once

#include <array>

#include "lowlap/scale/ratio_support.h"

namespace lowlap {

/// The error of one feature at a few log ratios between which it is taken as
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
    double begin = at_[0];
    for (int n = 1; n < size_; ++n) {
      if ((error_px_[n] < threshold_px) == inside) continue;
      const double crossing = Crossing(n - 1, threshold_px);
      if (inside) visit(begin, crossing);
      begin = crossing;
      inside = !inside;
    }
    if (inside) visit(begin, at_[size_ - 1]);
  }

 private:
  static constexpr int kMaxSize = kMaxTurns + 3;

  // Where the error crosses the threshold between two of the log ratios.
  double Crossing(int n, float threshold_px) const;

  const RatioSupport& support_;
  FeatureKind kind_;
  int index_;
  int size_ = 0;
  std::array<double, kMaxSize> at_;
  std::array<float, kMaxSize> error_px_;
};

/// Calls visit(step, begin, end) for the intervals of log ratios in [low, high]
/// in which one feature is an inlier, for the steps of the ladder from
/// `first_step` up to, and without, `end_step`.
template <class Visit>
void VisitInlierIntervals(const RatioSupport& support, FeatureKind kind,
                          int index, double low, double high, int first_step,
                          int end_step, const Visit& visit) {
  if (first_step >= end_step) return;
  const FeatureProfile profile(support, kind, index, low, high);
  for (int step = first_step; step < end_step; ++step) {
    profile.VisitBelow(
        static_cast<float>(LadderThresholdPx(step)),
        [&](double begin, double end) { visit(step, begin, end); });
  }
}

}  // namespace lowlap
