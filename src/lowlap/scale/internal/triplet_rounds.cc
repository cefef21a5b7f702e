#include "lowlap/scale/internal/triplet_rounds.h"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace lowlap {

std::vector<std::size_t> LargestFirst(
    const Scene& scene, const std::vector<ViewTriplet>& triplets) {
  const auto num_matches = [&](ViewId a, ViewId b) -> std::size_t {
    const RelativePose* edge = scene.FindRelativePose(a, b);
    if (edge == nullptr) return 0;
    return edge->point_inliers.size() + edge->line_inliers.size();
  };
  std::vector<std::size_t> size;
  for (const ViewTriplet& views : triplets) {
    size.push_back(num_matches(views.first, views.middle) +
                   num_matches(views.middle, views.last));
  }
  std::vector<std::size_t> order(triplets.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(
      order.begin(), order.end(),
      [&](std::size_t a, std::size_t b) { return size[a] > size[b]; });
  return order;
}

bool HasFeatures(const NormalizedFeaturesByView& features,
                 const ViewTriplet& views) {
  return features.count(views.first) > 0 && features.count(views.middle) > 0 &&
         features.count(views.last) > 0;
}

void PayForSecondTest(ScaleRatio* ratio) {
  if (ratio->verdict == RatioVerdict::kNoCandidates) return;
  ratio->log10_nfa += std::log10(2.0);
  if (ratio->second_mode) ratio->second_mode->log10_nfa += std::log10(2.0);
  if (!(ratio->log10_nfa < 0)) ratio->verdict = RatioVerdict::kNotMeaningful;
}

}  // namespace lowlap
