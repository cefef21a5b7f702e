#pragma once

#include <cmath>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Every view with the numbers of its points and segments, quick to look up.
class ViewTable {
 public:
  struct Entry {
    ViewId view;
    std::size_t points, segments;  // zero without features
  };

  explicit ViewTable(const Scene& scene);
  /// nullptr: there is no such view.
  const Entry* Find(ViewId view) const;

 private:
  std::vector<Entry> entries_;  // sorted by view
};

// The parts of ValidateScene, in its order.
Status ValidateCameras(const Scene& scene, const ViewTable& views);
Status ValidateStructure(const Scene& scene, const ViewTable& views);
Status ValidateFeatures(const Scene& scene, const ViewTable& views);
Status ValidateRelativePoses(const Scene& scene, const ViewTable& views);
Status ValidateUnrelatedPairs(const Scene& scene, const ViewTable& views);
Status ValidateTracks(const Scene& scene, const ViewTable& views);
Status ValidateScaleRatios(const Scene& scene, const ViewTable& views);
Status ValidateLineStructure(const Scene& scene, const ViewTable& views);

inline bool IsUnit(const Vec3& v) {
  return std::abs(v.norm() - 1) <= kUnitTolerance;  // false for NaN
}

/// Finite and symmetric, without a negative variance.
template <int kSize>
bool IsCovariance(const Eigen::Matrix<double, kSize, kSize>& matrix) {
  const double asymmetry = (matrix - matrix.transpose()).cwiseAbs().maxCoeff();
  return matrix.allFinite() && matrix.diagonal().minCoeff() >= 0 &&
         asymmetry <= kUnitTolerance * matrix.cwiseAbs().maxCoeff();
}
inline constexpr char kNoCovariance[] =
    "must be finite and symmetric, without a negative variance";

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

enum class FeatureKind { kPoint, kSegment };

/// The rules for a track, or for the observations of a line landmark; `place`
/// is that of the record that has the flat array "observations".
Status ValidateTrack(const ViewTable& views, const Track& track,
                     FeatureKind kind, const std::string& place);

}  // namespace lowlap
