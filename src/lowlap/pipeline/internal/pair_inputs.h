#pragma once

#include <map>
#include <optional>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scene/scene.h"
#include "lowlap/two_view/internal/pair_estimator.h"

namespace lowlap {

/// The relative poses of a scene as input of what looks at one pair.
class PairInputs {
 public:
  /// Views without an intrinsic, an image size or features are left out.
  explicit PairInputs(const Scene& scene);

  /// Finds the vanishing directions of the views of these pairs; without them
  /// lines say nothing. Errors: kCancelled.
  Status FindDirections(const std::vector<ViewPair>& pairs,
                        const RunContext& context);

  /// The inliers of a pose as matches. Refers to this object; nullopt where a
  /// view is left out.
  std::optional<TwoViewInput> Of(const RelativePose& pose) const;

 private:
  std::map<ViewId, ViewMeasurements> views_;
};

}  // namespace lowlap
