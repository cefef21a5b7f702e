#include "lowlap/scene/validation.h"

#include <algorithm>

#include "lowlap/scene/internal/validation_parts.h"

namespace lowlap {

std::string ItemPlace(const char* section, std::uint32_t id) {
  return std::string("$.") + section + "[key=" + std::to_string(id) + "]";
}

std::string OwnItemPlace(const char* section, const char* name,
                         const std::string& id) {
  return std::string("$.lowlap.") + section + "[" + name + "=" + id + "]";
}

std::string IndexPlace(std::size_t index) {
  return "[" + std::to_string(index) + "]";
}

std::string UnknownView(ViewId view) {
  return "there is no view " + std::to_string(view.value());
}

ViewTable::ViewTable(const Scene& scene) {
  entries_.reserve(scene.views.size());
  auto features = scene.features.begin();
  for (const auto& [view, unused] : scene.views) {
    entries_.push_back({view, 0, 0});
    while (features != scene.features.end() && features->first < view) {
      ++features;
    }
    if (features != scene.features.end() && features->first == view) {
      entries_.back().points = features->second.points_px.size();
      entries_.back().segments = features->second.segments.size();
    }
  }
}

const ViewTable::Entry* ViewTable::Find(ViewId view) const {
  // Mostly the ids are 0, 1, 2, ...
  if (view < entries_.size() && entries_[view.value()].view == view) {
    return &entries_[view.value()];
  }
  const auto found = std::lower_bound(
      entries_.begin(), entries_.end(), view,
      [](const Entry& entry, ViewId id) { return entry.view < id; });
  return found != entries_.end() && found->view == view ? &*found : nullptr;
}

Status ValidateScene(const Scene& scene) {
  const ViewTable views(scene);
  for (const auto part :
       {ValidateCameras, ValidateStructure, ValidateFeatures,
        ValidateRelativePoses, ValidateUnrelatedPairs, ValidateTracks,
        ValidateScaleRatios, ValidateLineStructure}) {
    if (Status status = part(scene, views); !status) return status;
  }
  return {};
}

}  // namespace lowlap
