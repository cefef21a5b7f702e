#pragma once

#include <vector>

#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"

namespace lowlap {

/// The leverage of each match on a pose that minimises the loss of
/// RefineRelativePose,
///   h = w J^T H^-1 J,  H = sum w J J^T + the information of the directions,
/// w the weight of its residual, J its derivative: the share that the match
/// alone has in all that is known of the pose along its own constraint, from 0
/// to 1 (Hoaglin, Welsch, "The hat matrix in regression and ANOVA", 1978). In
/// the order of `indices`; empty if H is singular.
std::vector<double> Leverages(const RigidTransform& cam2_from_cam1,
                              const PointPairs& pairs,
                              const std::vector<int>& indices,
                              const PoseRefinementOptions& options);

/// `indices` without the matches that hold the pose alone. What a match with
/// h > 1/2 says of the pose has less behind it in all the others together than
/// in itself; the pose goes through it whether it is right or wrong, and no
/// residual tells. All stay where the rest is fewer than six.
///
/// They are left out once: what is left has larger leverages, and of few
/// matches the next pass would find more, and so on down to six that hold
/// nothing.
///
/// The pose may well be right; what is known of it is what the rest knows.
std::vector<int> BorneOutMatches(const RigidTransform& cam2_from_cam1,
                                 const PointPairs& pairs,
                                 const std::vector<int>& indices,
                                 const PoseRefinementOptions& options);

}  // namespace lowlap
