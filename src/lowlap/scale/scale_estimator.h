#pragma once

#include <memory>

#include "lowlap/core/result.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/scale/triplet_view.h"
#include "lowlap/scene/scale_ratio.h"

namespace lowlap {

/// Finds the ratio tau = lambda(j, k) / lambda(i, j) of a triplet. Estimators
/// hold no state between calls and may be shared by threads.
class ScaleEstimator {
 public:
  virtual ~ScaleEstimator() = default;

  /// A triplet without support is not an error but a verdict
  /// (kNoCandidates, kNotMeaningful). kInvalidArgument: a transform, focal
  /// length or image size that is not finite or not positive.
  ///
  /// In the result, the counts of the kind `coplanar` are pairs of lines.
  virtual Result<ScaleRatio> Estimate(const TripletView& triplet) const = 0;
};

/// What Estimate demands of its input; see there.
Status CheckTriplet(const TripletView& triplet);

/// The estimator that `options.criterion` names; the options must be valid.
std::unique_ptr<ScaleEstimator> MakeScaleEstimator(const ScaleOptions& options);

}  // namespace lowlap
