#include "lowlap/adjustment/internal/structure/noise_scale.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lowlap/core/internal/median.h"

namespace lowlap {

NoiseScale EstimateNoise(const std::vector<double>& errors_px,
                         const BackgroundLaw& law, double unit_median,
                         const NoiseBounds& bounds) {
  const auto bounded = [&](NoiseScale scale) {
    scale.threshold_px = std::clamp(scale.threshold_px, bounds.min_threshold_px,
                                    bounds.max_threshold_px);
    scale.stddev_px = std::max(scale.stddev_px, bounds.min_threshold_px / 20);
    return scale;
  };
  if (errors_px.size() < kMinErrors) return bounded(bounds.fallback);

  std::vector<float> squared;
  squared.reserve(errors_px.size());
  for (const double error : errors_px) {
    // Whatever is beyond every threshold, infinity included, is one step.
    const double capped = std::min(error, 1e6);
    squared.push_back(static_cast<float>(capped * capped));
  }
  const AContrarioLadder ladder(static_cast<int>(squared.size()), 0, 1, law,
                                bounds.min_threshold_px,
                                bounds.max_threshold_px);
  const AContrarioScore score = ladder.Score(squared);
  if (!(score.log10_nfa < 0)) return bounded(bounds.fallback);

  std::vector<double> inliers;
  for (const double error : errors_px) {
    if (error <= score.threshold) inliers.push_back(error);
  }
  if (inliers.empty()) return bounded(bounds.fallback);
  return bounded({Median(std::move(inliers)) / unit_median, score.threshold});
}

}  // namespace lowlap
