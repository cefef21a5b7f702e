#pragma once

#include <optional>
#include <vector>

#include "lowlap/two_view/internal/planes/planar_motion.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"

namespace lowlap {

/// The motion, and the plane, that minimise the loss of RefineRelativePose over
/// the matches named by `indices`; those on the plane count with their
/// TransferResidual, in two dimensions. Epipolar lines alone leave the points
/// of a plane a valley of motions, in which the noise along the lines, taken
/// for relief, decides.
RigidTransform RefineOnPlane(const RigidTransform& cam2_from_cam1,
                             const PointPairs& pairs,
                             const std::vector<int>& indices,
                             const PoseRefinementOptions& options,
                             ScenePlane* plane);

/// RelativePoseCovariance, of what the inliers of a plane say of the motion in
/// two dimensions, the plane unknown.
std::optional<Mat5> CovarianceOnPlane(const RigidTransform& cam2_from_cam1,
                                      const PointPairs& pairs,
                                      const ScenePlane& plane,
                                      const PoseRefinementOptions& options);

}  // namespace lowlap
