#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap::internal {

// The parts of ValidateScene, in its order.
Status ValidateCameras(const Scene& scene);
Status ValidateFeatures(const Scene& scene);
Status ValidateRelativePoses(const Scene& scene);
Status ValidateTracks(const Scene& scene);
Status ValidateScaleRatios(const Scene& scene);
Status ValidateStructure(const Scene& scene);
Status ValidateLineStructure(const Scene& scene);

/// How far from a rotation, or from unit length, a value may be.
inline constexpr double kTolerance = 1e-6;

inline bool IsUnit(const Vec3& v) {
  return std::abs(v.norm() - 1) <= kTolerance;  // false for NaN
}

inline tl::unexpected<Error> Invalid(std::string message, std::string place) {
  return MakeError(ErrorCode::kInvalidScene, std::move(message), {},
                   std::move(place));
}

/// "$.section[key=id]", and "$.lowlap.section[name=id]".
std::string ItemPlace(const char* section, std::uint32_t id);
std::string OwnItemPlace(const char* section, const char* name,
                         const std::string& id);
std::string IndexPlace(std::size_t index);  // "[index]"

std::string UnknownView(ViewId view);  // the message

/// How many points and segments a view has; zero without features.
struct FeatureCounts {
  explicit FeatureCounts(const ViewFeatures* features)
      : points(features ? features->points_px.size() : 0),
        segments(features ? features->segments.size() : 0) {}
  std::size_t points, segments;
};
FeatureCounts CountFeatures(const Scene& scene, ViewId view);

enum class FeatureKind { kPoint, kSegment };

/// The rules for a track, or for the observations of a line landmark; `place`
/// is that of the record that has the flat array "observations".
Status ValidateTrack(const Scene& scene, const Track& track, FeatureKind kind,
                     const std::string& place);

}  // namespace lowlap::internal
