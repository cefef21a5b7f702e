#include "lowlap/averaging/reliability/internal/lost_features.h"

#include <cstddef>
#include <map>
#include <set>
#include <utility>

namespace lowlap {
namespace {

// Adds, per view, the features of the tracks and those of them that landmarks
// observe.
struct FeatureCount {
  std::size_t matched = 0;
  std::size_t fitting = 0;
};

template <class Tracks, class Landmarks>
void CountFeatures(const Scene& scene, const Tracks& tracks,
                   const Landmarks& landmarks, std::size_t min_views,
                   std::map<ViewId, FeatureCount>* counts) {
  for (const auto& [id, track] : tracks) {
    std::set<ViewId> views;  // a line may be in pieces in one of them
    for (const FeatureRef& ref : track) {
      // Without an intrinsic nothing of a view can be triangulated.
      if (scene.FindPose(ref.view) != nullptr &&
          scene.FindIntrinsic(ref.view) != nullptr) {
        views.insert(ref.view);
      }
    }
    if (views.size() < min_views) continue;
    std::set<ViewId> fitting;
    if (const auto found = landmarks.find(id); found != landmarks.end()) {
      for (const auto& seen : found->second.observations) {
        fitting.insert(seen.view);
      }
    }
    for (const ViewId view : views) {
      FeatureCount& count = (*counts)[view];
      ++count.matched;
      if (fitting.count(view) > 0) ++count.fitting;
    }
  }
}

}  // namespace

std::vector<ReliabilityWarning> FindLostFeatures(const Scene& scene) {
  std::map<ViewId, FeatureCount> counts;
  CountFeatures(scene, scene.point_tracks, scene.structure, 2, &counts);
  CountFeatures(scene, scene.line_tracks, scene.line_structure, 3, &counts);
  std::vector<ReliabilityWarning> warnings;
  for (const auto& [view, count] : counts) {
    if (2 * count.fitting >= count.matched) continue;
    ReliabilityWarning warning;
    warning.reason = WarningReason::kLostFeatures;
    warning.views = {view};
    warning.share =
        static_cast<double>(count.fitting) / static_cast<double>(count.matched);
    warnings.push_back(std::move(warning));
  }
  return warnings;
}

}  // namespace lowlap
