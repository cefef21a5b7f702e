#pragma once

#include <vector>

#include "lowlap/scene/features.h"
#include "lowlap/scene/intrinsic.h"

namespace lowlap {

/// A segment in undistorted normalised coordinates (z = 1).
struct NormalizedSegment {
  Vec3 start = Vec3::UnitZ();
  Vec3 end = Vec3::UnitZ();
  /// Unit normal of the interpretation plane, start x end normalised; zero for
  /// a segment that could not be undistorted or has no length.
  Vec3 normal = Vec3::Zero();

  bool IsValid() const { return normal.squaredNorm() > 0; }
};

/// The features of a view as the geometry sees them: undistorted and
/// normalised once, with the same indices. Points that cannot be undistorted
/// have z = 0.
struct NormalizedFeatures {
  std::vector<Vec3> points;  // (x, y, 1)
  std::vector<NormalizedSegment> segments;
  double focal_px = 1;  // pixels per unit, for residuals that a person sees
};

NormalizedFeatures NormalizeFeatures(const ViewFeatures& features,
                                     const Intrinsic& intrinsic);

NormalizedSegment NormalizeSegment(const LineSegment& segment,
                                   const Intrinsic& intrinsic);

}  // namespace lowlap
