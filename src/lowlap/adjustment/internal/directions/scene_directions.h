#pragma once

#include <vector>

#include "lowlap/adjustment/internal/camera_set.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// A direction of parallel lines as one camera sees it.
struct DirectionSight {
  int pose = -1;                   // index into CameraSet::poses
  Vec3 direction = Vec3::UnitZ();  // in camera, of either sign
  Mat3 covariance = Mat3::Zero();  // its null space is the direction
  double log10_nfa = 0;
};

/// A direction of the scene, and who sees it.
struct SceneDirection {
  Vec3 direction = Vec3::UnitZ();  // unit, in world
  std::vector<DirectionSight> sights;
};

/// The vanishing directions of all cameras (FindVanishingDirections), the most
/// meaningful first. To their covariances comes parallel_stddev_deg
/// (VanishingOptions) across: the walls of a scene differ as lines of one wall
/// do. Errors: kCancelled.
Result<std::vector<DirectionSight>> FindDirectionSights(
    const Scene& scene, const CameraSet& cameras, const RunContext& context);

/// The directions that two cameras see at least, under the rotations as they
/// are; no angles between them are assumed. From the most meaningful sight on,
/// each gathers those that agree with it to within three deviations, half a
/// degree of the rotations included, one per camera.
///
/// What is built is less parallel in one house than in another: all covariances
/// are scaled by the median of the squared deviations from the common
/// directions over its expectation, where that is more than one.
std::vector<SceneDirection> GroupDirections(
    const std::vector<DirectionSight>& sights, const CameraSet& cameras);

}  // namespace lowlap
