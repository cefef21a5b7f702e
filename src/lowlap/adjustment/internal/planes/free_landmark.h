#pragma once

#include <algorithm>
#include <cmath>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"

namespace lowlap {

/// A place on a landmark as its own observations have it, whatever it was
/// adjusted to, and its covariance (world units squared).
struct FreePlace {
  Vec3 point = Vec3::Zero();
  Mat3 covariance = Mat3::Zero();

  double Stddev(const Vec3& normal) const {
    return std::sqrt(std::max(0.0, normal.dot(covariance * normal)));
  }
};

/// A point, or the two ends of a line's extent.
struct FreeLandmark {
  bool is_line = false;
  int index = -1;  // into StructureState::points or lines
  std::vector<FreePlace> places;
  std::vector<int> poses;  // that see it, indices into CameraSet::poses

  /// Mean of the places.
  Vec3 Center() const;
};

/// Of all landmarks of the used kinds that their observations determine:
/// points, then lines.
std::vector<FreeLandmark> FreeLandmarks(const AdjustmentOptions& options,
                                        const NoiseLevels& noise,
                                        const CameraSet& cameras,
                                        const StructureState& state);

}  // namespace lowlap
