#include "lowlap/scale/internal/triplet_rounds.h"

#include <algorithm>
#include <numeric>
#include <utility>

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

Result<EvidenceKinds> PrepareRound(const EvidenceKinds& kinds,
                                   EvidenceRound round,
                                   const SceneFeatures& features,
                                   const std::vector<ViewTriplet>& triplets,
                                   const RunContext& context) {
  EvidenceKinds asked;
  for (const auto& kind : kinds) {
    if (kind->Round() != round) continue;
    auto prepared = kind->Prepare(features, triplets, context);
    if (!prepared) return tl::unexpected<Error>(prepared.error());
    asked.push_back(*prepared == nullptr ? kind : std::move(*prepared));
  }
  return asked;
}

bool MaySpeak(const EvidenceKinds& kinds, EvidenceRound round,
              const SceneFeatures& features, const ViewTriplet& views) {
  return std::any_of(kinds.begin(), kinds.end(), [&](const auto& kind) {
    return kind->Round() == round && kind->MaySpeak(features, views);
  });
}

}  // namespace lowlap
