#include "lowlap/scale/internal/triplet_rounds.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
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
  size.reserve(triplets.size());
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
    asked.push_back(kind);
    if (*prepared != nullptr) asked.back() = std::move(*prepared);
  }
  return asked;
}

bool IsDefined(const ScaleRatio& ratio) {
  const auto& mode = ratio.second_mode;
  return std::isfinite(ratio.log_ratio) &&
         std::isfinite(ratio.log_ratio_stddev) &&
         std::isfinite(ratio.log10_nfa) &&
         (!mode ||
          (std::isfinite(mode->log_ratio) && std::isfinite(mode->log10_nfa))) &&
         std::all_of(ratio.kinds.begin(), ratio.kinds.end(),
                     [](const KindSupport& kind) {
                       return std::isfinite(kind.log10_nfa) &&
                              std::isfinite(kind.threshold_px) &&
                              std::isfinite(kind.information_share);
                     });
}

void WarnOfFailures(const Scene& scene,
                    const std::vector<ViewTriplet>& triplets,
                    const std::vector<const Error*>& failures,
                    const RunContext& context) {
  const auto failed = [](const Error* error) { return error != nullptr; };
  const auto first = std::find_if(failures.begin(), failures.end(), failed);
  if (first == failures.end()) return;
  const auto name = [&](ViewId view) { return scene.NameOf(view); };
  const ViewTriplet& views = triplets[first - failures.begin()];
  context.Log(LogLevel::kWarning,
              "the estimation of a scale ratio failed at " +
                  std::to_string(std::count_if(first, failures.end(), failed)) +
                  " of " + std::to_string(triplets.size()) +
                  " triplets, first at " + name(views.first) + ", " +
                  name(views.middle) + " and " + name(views.last) + ": " +
                  (*first)->ToString());
}

bool MaySpeak(const EvidenceKinds& kinds, EvidenceRound round,
              const SceneFeatures& features, const ViewTriplet& views) {
  return std::any_of(kinds.begin(), kinds.end(), [&](const auto& kind) {
    return kind->Round() == round && kind->MaySpeak(features, views);
  });
}

}  // namespace lowlap
