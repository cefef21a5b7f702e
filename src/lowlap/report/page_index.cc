#include <algorithm>
#include <vector>

#include "lowlap/report/internal/page_parts.h"

namespace lowlap {
namespace {

std::size_t StrideFor(std::size_t count, std::size_t most) {
  return most == 0 ? count + 1
                   : std::max<std::size_t>(1, (count + most - 1) / most);
}

// Whole tracks are kept or dropped, so that matches keep both their ends.
void IndexFeatures(const Scene& scene, std::size_t stride, PageIndex* index) {
  std::map<ViewId, std::vector<bool>> kept;
  for (const auto& [view, features] : scene.features) {
    std::vector<bool>& flags = kept[view];
    flags.resize(features.points_px.size());
    for (std::size_t n = 0; n < flags.size(); ++n) flags[n] = n % stride == 0;
  }
  std::size_t place = 0;
  for (const auto& [id, track] : scene.point_tracks) {
    const bool keep = place++ % stride == 0;
    for (const FeatureRef& ref : track) {
      const auto flags = kept.find(ref.view);
      if (flags != kept.end() && ref.feature < flags->second.size()) {
        flags->second[ref.feature] = keep;
      }
    }
  }
  for (const auto& [view, flags] : kept) {
    std::vector<std::uint32_t>& places = index->features[view];
    places.assign(flags.size(), kNoLandmark);
    std::uint32_t next = 0;
    for (std::size_t n = 0; n < flags.size(); ++n) {
      if (flags[n]) places[n] = next++;
    }
  }
}

}  // namespace

PageIndex MakePageIndex(const Scene& scene, const PageLimits& limits) {
  PageIndex index;
  for (const auto& [id, view] : scene.views) {
    index.views.emplace(id, static_cast<std::uint32_t>(index.views.size()));
  }
  index.point_stride = StrideFor(scene.structure.size(), limits.points);
  std::size_t n = 0;
  for (const auto& [id, landmark] : scene.structure) {
    if (n++ % index.point_stride != 0) continue;
    index.points.emplace(id, static_cast<std::uint32_t>(index.points.size()));
  }
  for (const auto& [id, line] : scene.line_structure) {
    index.lines.emplace(id, static_cast<std::uint32_t>(index.lines.size()));
  }
  std::size_t num_features = 0;
  for (const auto& [view, features] : scene.features) {
    num_features += features.points_px.size();
  }
  index.feature_stride = StrideFor(num_features, limits.features);
  IndexFeatures(scene, index.feature_stride, &index);
  return index;
}

}  // namespace lowlap
