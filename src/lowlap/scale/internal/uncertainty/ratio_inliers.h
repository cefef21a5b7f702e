#pragma once

#include "lowlap/scale/internal/criterion/ratio_support.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/scale_ratio.h"

namespace lowlap {

/// Inlier thresholds in pixels by kind; 0 leaves the kind out.
struct InlierThresholds {
  double points_px = 0;
  double lines_px = 0;
  double coplanar_px = 0;
  double plane_points_px = 0;
  int num_pairs = 0;  // the pairs that are considered, from the nearest tier on
};

/// A ratio with the triplet's names and candidate counts, and no verdict yet.
ScaleRatio EmptyRatio(const TripletView& triplet, const RatioSupport& support);

/// Refines a log ratio (RefineRatio) on every feature of the kinds with a
/// threshold that is anywhere near: a threshold that is best for telling right
/// from wrong is too tight for an average, which it ties to where it started,
/// and makes the noise look too small. The inliers only say how large the noise
/// is to begin with.
/// Fills log_ratio and log_ratio_stddev (with the part that comes from the
/// relative poses, where their covariance is known), the shares of information,
/// and for the refined ratio the inlier counts, thresholds and coplanar inliers
/// of `ratio`. A ratio that no feature bears out stays as it is, with the
/// deviation kMaxLogRatioStddev.
void RefineOnInliers(const TripletView& triplet, const RatioSupport& support,
                     const InlierThresholds& thresholds, double log_ratio,
                     ScaleRatio* ratio);

}  // namespace lowlap
