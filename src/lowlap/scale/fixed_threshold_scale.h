#pragma once

#include "lowlap/scale/scale_estimator.h"

namespace lowlap {

/// The ratio with the most inliers within a fixed threshold, as in Salaün et
/// al. 2017, section 5 (RANSAC that tries every feature), for comparison: among
/// those that the features ask for, the one with the most inlier points, lines
/// and coplanar pairs together, and of equals the one with the least error. It
/// is refined on its inliers, as the a-contrario one is.
///
/// RANSAC has no measure of chance. So that its ratios can be ranked and used
/// like the others, the NFA of the winner is that of the enabled NFA form, and
/// the verdict is kMeaningful as soon as a second feature agrees.
class FixedThresholdScaleEstimator : public ScaleEstimator {
 public:
  explicit FixedThresholdScaleEstimator(const ScaleOptions& options)
      : options_(options) {}
  Result<ScaleRatio> Estimate(const TripletView& triplet) const override;

 private:
  ScaleOptions options_;
};

}  // namespace lowlap
