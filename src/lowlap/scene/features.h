#pragma once

#include <vector>

#include "lowlap/geometry/types.h"

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

  friend bool operator==(const ViewFeatures& a, const ViewFeatures& b) {
    return a.points_px == b.points_px &&
           a.point_covariances == b.point_covariances &&
           a.segments == b.segments;
  }
};

}  // namespace lowlap
