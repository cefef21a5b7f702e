#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/geometry/types.h"
#include "lowlap/scene/intrinsic.h"

namespace lowlap {

/// A detected line segment, in raw (distorted) pixels.
struct LineSegment {
  Vec2 start_px = Vec2::Zero();
  Vec2 end_px = Vec2::Zero();
  /// Standard deviation of an end point across the segment.
  double stddev_px = 0.5;

  double LengthPx() const { return (end_px - start_px).norm(); }

  friend bool operator==(const LineSegment& a, const LineSegment& b) {
    return a.start_px == b.start_px && a.end_px == b.end_px &&
           a.stddev_px == b.stddev_px;
  }
};

/// The features of one view, addressed everywhere by their index. For scenes
/// that come from OpenMVG, the point index is the line of the .feat file.
struct ViewFeatures {
  std::vector<Vec2> points_px;  // raw (distorted) pixels
  /// Shape of each point's error: its covariance (xx, xy, yy), in units of the
  /// variance in its better direction. Empty: round.
  std::vector<Vec3> point_covariances;
  std::vector<LineSegment> segments;
  /// Those that belong to a pattern which repeats in the photograph, ascending:
  /// where a match of one copy is right, that of the next would look as good.
  std::vector<FeatureIndex> repeated_points;
  std::vector<FeatureIndex> repeated_segments;

  friend bool operator==(const ViewFeatures& a, const ViewFeatures& b) {
    return a.points_px == b.points_px &&
           a.point_covariances == b.point_covariances &&
           a.segments == b.segments && a.repeated_points == b.repeated_points &&
           a.repeated_segments == b.repeated_segments;
  }
};

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
