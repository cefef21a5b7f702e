#pragma once

#include <map>
#include <optional>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/scene/features.h"
#include "lowlap/scene/scene.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"

namespace lowlap {

/// The relative poses of a scene as input of what looks at one pair.
class PairInputs {
 public:
  /// Views without an intrinsic, an image size or features are left out.
  explicit PairInputs(const Scene& scene);

  /// Finds the vanishing directions of a view, if it is in.
  void FindDirectionsOf(ViewId view);

  /// The inliers of a pose as matches, with the directions that were found.
  /// Refers to this object; nullopt where a view is left out.
  std::optional<TwoViewInput> Of(const RelativePose& pose) const;

 private:
  struct View {
    NormalizedFeatures features;
    Vec2 image_size_px = Vec2::Zero();
    std::optional<std::vector<VanishingDirection>> directions;
  };
  std::map<ViewId, View> views_;
};

}  // namespace lowlap
