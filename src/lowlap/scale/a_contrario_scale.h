#pragma once

#include "lowlap/scale/scale_estimator.h"

namespace lowlap {

/// The ratio of least NFA (ratio_nfa.h) among those that the features ask for
/// (ratio_search.h), refined on its inliers. Inliers are the features of the
/// kinds whose own NFA is below 1, within the threshold at which it is least.
/// Meaningful if log10 NFA < 0; of a ratio that is not, the best guess and
/// what supports it are reported all the same.
class AContrarioScaleEstimator : public ScaleEstimator {
 public:
  explicit AContrarioScaleEstimator(const ScaleOptions& options)
      : options_(options) {}
  Result<ScaleRatio> Estimate(const TripletView& triplet) const override;

 private:
  ScaleOptions options_;
};

}  // namespace lowlap
