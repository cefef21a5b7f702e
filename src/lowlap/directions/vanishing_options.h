#pragma once

namespace lowlap {

struct VanishingOptions {
  int max_directions = 8;
  /// Directions are sought among this many segments, the longest.
  int max_segments = 300;
  /// A segment is parallel to the direction if its support line, turned about
  /// its midpoint by no more than this, passes through the vanishing point.
  double max_angle_deg = 1.5;
  /// Noise of an end point across its segment.
  double end_point_stddev_px = 0.3;
  /// By how much lines that people build parallel differ from parallel.
  double parallel_stddev_deg = 0.1;
};

}  // namespace lowlap
