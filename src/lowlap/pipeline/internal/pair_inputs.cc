#include "lowlap/pipeline/internal/pair_inputs.h"

#include "lowlap/directions/internal/vanishing_directions.h"

namespace lowlap {

PairInputs::PairInputs(const Scene& scene) {
  for (const auto& [view, features] : scene.features) {
    const Intrinsic* intrinsic = scene.FindIntrinsic(view);
    if (intrinsic == nullptr) continue;
    const Vec2 size_px(intrinsic->width_px, intrinsic->height_px);
    if (!(size_px.minCoeff() > 0)) continue;
    views_[view] = {NormalizeFeatures(features, *intrinsic), size_px,
                    std::nullopt};
  }
}

void PairInputs::FindDirectionsOf(ViewId view) {
  const auto found = views_.find(view);
  if (found == views_.end() || found->second.directions) return;
  found->second.directions =
      FindVanishingDirections(found->second.features, VanishingOptions());
}

std::optional<TwoViewInput> PairInputs::Of(const RelativePose& pose) const {
  const auto first = views_.find(pose.views.first);
  const auto second = views_.find(pose.views.second);
  if (first == views_.end() || second == views_.end()) return std::nullopt;
  TwoViewInput input;
  input.views = pose.views;
  input.features1 = &first->second.features;
  input.features2 = &second->second.features;
  input.point_matches = pose.point_inliers;
  input.line_matches = pose.line_inliers;
  if (first->second.directions) input.directions1 = &*first->second.directions;
  if (second->second.directions) {
    input.directions2 = &*second->second.directions;
  }
  input.image_size1_px = first->second.image_size_px;
  input.image_size2_px = second->second.image_size_px;
  return input;
}

}  // namespace lowlap
