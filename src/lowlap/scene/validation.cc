#include "lowlap/scene/validation.h"

#include "lowlap/scene/internal/validation_parts.h"

namespace lowlap {
namespace internal {

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
  return "there is no view " + std::to_string(view);
}

FeatureCounts CountFeatures(const Scene& scene, ViewId view) {
  const auto found = scene.features.find(view);
  return FeatureCounts(found == scene.features.end() ? nullptr
                                                     : &found->second);
}

}  // namespace internal

Status ValidateScene(const Scene& scene) {
  for (const auto part :
       {internal::ValidateCameras, internal::ValidateStructure,
        internal::ValidateFeatures, internal::ValidateRelativePoses,
        internal::ValidateTracks, internal::ValidateScaleRatios,
        internal::ValidateLineStructure}) {
    if (Status status = part(scene); !status) return status;
  }
  return {};
}

}  // namespace lowlap
