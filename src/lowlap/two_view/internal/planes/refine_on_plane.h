#pragma once

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

/// sum J^T J over the inliers of a plane for (w, d), the plane unknown: what
/// they say of the motion, in place of their epipolar residuals.
Mat5 InformationOfPlane(const RigidTransform& cam2_from_cam1,
                        const PointPairs& pairs, const ScenePlane& plane);

}  // namespace lowlap
