#pragma once

#include "lowlap/core/result.h"
#include "lowlap/matching/match_options.h"

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

struct TwoViewOptions {
  /// Upper bound of the a-contrario threshold. It only has to be wide enough
  /// for the worst calibration that is to be accepted.
  double max_threshold_px = 4;
  /// Upper bound of the samples drawn; the count adapts to the inlier rate.
  int max_samples = 10000;
  /// Probability with which a sample of inliers only is drawn at least once.
  double confidence = 0.9999;

  Status Validate() const;
};

struct PairOptions {
  TwoViewOptions two_view;
  /// What relative poses are estimated from; at least one.
  bool use_points = true;
  bool use_lines = true;
  GuidedLineOptions guided_lines;
  GuidedPointOptions guided_points;
  /// Points are matched again under the first pose if it has fewer inliers.
  int starved_below = 2000;
  LineFilterOptions line_filter;

  Status Validate() const;
};

}  // namespace lowlap
