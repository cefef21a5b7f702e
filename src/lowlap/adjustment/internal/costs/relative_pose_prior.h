#pragma once

#include <vector>

#include "lowlap/adjustment/internal/camera_set.h"
#include "lowlap/adjustment/internal/costs/relative_pose_cost.h"

namespace lowlap {

/// A measured relative pose of two poses of the set.
struct RelativePosePrior {
  int first = -1;  // indices into CameraSet::poses
  int second = -1;
  MeasuredRelativePose measured;
};

/// The relative poses of the scene that state a covariance and that the poses
/// agree with to within ten degrees of rotation and thirty of direction (the
/// others are false, and the loss would only be slow to say so). What a
/// relative pose knows beyond the points and lines of the scene is the common
/// direction of parallel lines and the shape of the points' errors; where
/// structure is thin, that holds the poses. To the stated covariance come 0.1
/// degrees of rotation and 0.3 of direction, which no number of features
/// averages out: many points outweigh it.
std::vector<RelativePosePrior> LoadRelativePosePriors(const Scene& scene,
                                                      const CameraSet& cameras);

}  // namespace lowlap
