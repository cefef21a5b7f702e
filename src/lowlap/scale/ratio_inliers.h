#pragma once

#include "lowlap/scale/ratio_support.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/scale_ratio.h"

namespace lowlap {

/// Inlier thresholds in pixels by kind; 0 leaves the kind out.
struct InlierThresholds {
  double points_px = 0;
  double lines_px = 0;
  double coplanar_px = 0;
};

/// A ratio with the triplet's names and candidate counts, and no verdict yet.
ScaleRatio EmptyRatio(const TripletView& triplet, const RatioSupport& support);

/// Refines a log ratio on its inliers (RefineRatio, inliers found again after
/// each of two rounds), and fills log_ratio, log_ratio_stddev, the inlier
/// counts, thresholds and the coplanar inliers of `ratio`.
void RefineOnInliers(const TripletView& triplet, const RatioSupport& support,
                     const InlierThresholds& thresholds, double log_ratio,
                     ScaleRatio* ratio);

}  // namespace lowlap
