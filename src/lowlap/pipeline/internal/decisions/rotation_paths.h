#pragma once

#include <map>
#include <optional>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/scene/scene.h"
#include "lowlap/two_view/internal/informed_pose.h"

namespace lowlap {

/// What the rest of a scene says about the rotation of a pair, and through
/// which pairs.
struct PathPrior {
  RotationPrior rotation;
  std::vector<ViewPair> path;
};

/// Relative rotations along the relative poses of a scene.
class RotationPaths {
 public:
  /// `floor_rad` is added to every stated deviation, and so is, where several
  /// motions are open, how far their rotations are apart. A pose that states
  /// none is on no path.
  RotationPaths(const Scene& scene, double floor_rad);

  /// Of the rotation, about each axis, with the floor.
  double VarianceOf(const RelativePose& pose) const;

  /// Along the most certain path between the views that avoids the pair
  /// (Dijkstra's algorithm on variances); nullopt where there is none, or only
  /// such that add up to more than five degrees, which tell no two motions
  /// apart.
  std::optional<PathPrior> Find(const ViewPair& views) const;

  /// The pair of this pose has it from now on.
  void Replace(const RelativePose& pose);

 private:
  struct Link {
    ViewId to;
    Mat3 to_from_here;
    double variance;
  };

  void Connect(const RelativePose& pose);

  double floor_rad_;
  std::map<ViewId, std::vector<Link>> links_;
};

}  // namespace lowlap
