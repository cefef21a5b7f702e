#include "lowlap/pipeline/internal/pair_inputs.h"

#include <set>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/directions/internal/vanishing_directions.h"
#include "lowlap/scene/internal/pixel_unit.h"

namespace lowlap {

PairInputs::PairInputs(const Scene& scene) {
  for (const auto& [view, features] : scene.features) {
    const Intrinsic* intrinsic = scene.FindIntrinsic(view);
    if (intrinsic == nullptr) continue;
    const Vec2 size_px(intrinsic->width_px, intrinsic->height_px);
    if (!(size_px.minCoeff() > 0)) continue;
    ViewMeasurements& measurements = views_[view];
    measurements.features = NormalizeFeatures(features, *intrinsic);
    measurements.image_size_px = size_px;
  }
}

Status PairInputs::FindDirections(const std::vector<ViewPair>& pairs,
                                  const RunContext& context) {
  std::set<ViewId> views;
  for (const ViewPair& pair : pairs) views.insert({pair.first, pair.second});
  std::vector<ViewMeasurements*> to_find;
  for (const ViewId view : views) {
    const auto found = views_.find(view);
    if (found != views_.end()) to_find.push_back(&found->second);
  }
  return ParallelFor(context, "directions", to_find.size(), [&](std::size_t n) {
    ViewMeasurements& view = *to_find[n];
    view.directions =
        FindVanishingDirections(view.features, VanishingOptions(),
                                PixelUnit(view.image_size_px.norm()));
  });
}

std::optional<TwoViewInput> PairInputs::Of(const RelativePose& pose) const {
  const auto first = views_.find(pose.views.first);
  const auto second = views_.find(pose.views.second);
  if (first == views_.end() || second == views_.end()) return std::nullopt;
  TwoViewInput input = InputOf(pose.views, first->second, second->second);
  input.point_matches = pose.point_inliers;
  input.line_matches = pose.line_inliers;
  return input;
}

}  // namespace lowlap
