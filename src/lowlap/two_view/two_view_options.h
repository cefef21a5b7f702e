#pragma once

#include "lowlap/core/result.h"
#include "lowlap/matching/guided_match_options.h"

namespace lowlap {

struct TwoViewOptions {
  /// Upper bound of the a-contrario threshold, in images of up to 6 megapixels;
  /// in larger ones it grows with their diagonal. It only has to be wide enough
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
