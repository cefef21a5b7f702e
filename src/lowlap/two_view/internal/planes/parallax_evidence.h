#pragma once

#include <vector>

#include "lowlap/two_view/internal/planes/planar_motion.h"

namespace lowlap {

/// A match that lies off a plane, and its displacement: the length of its
/// TransferResidual.
struct DisplacedMatch {
  int pair = 0;
  double displacement_px = 0;
};

/// The matches that the plane puts further than twice `threshold_px` from their
/// places, ascending; those that it puts behind camera 2 are none.
std::vector<DisplacedMatch> DisplacedMatches(
    const RigidTransform& cam2_from_cam1, const ScenePlane& plane,
    const PointPairs& pairs, double threshold_px);

/// How meaningful it is (log10 NFA) that matches off the plane are displaced
/// along the epipolar lines of the motion, to within `threshold_px`.
///
/// The points of a plane only give its homography; where the epipole is, what
/// lies off the plane must tell. But matches that noise or a wrong choice among
/// similar features put beside their place look like that, too, if they lie on
/// their epipolar lines by chance. A displacement m (TransferResidual) without
/// meaning has any direction, and lies along the line with probability
///   p = 2/pi asin(threshold / |m|).
/// Two displacements give an epipole. Of the other n - 2 DisplacedMatches k - 2
/// lie along, and
///   NFA = n (n - 1) / 2 P(at least k - 2),
/// the probability by Hoeffding's inequality for the mean of the p
/// ("Probability inequalities for sums of bounded random variables", 1963).
/// `pairs` are all matches, not only those that were chosen by the motion.
double ParallaxEvidence(const RigidTransform& cam2_from_cam1,
                        const ScenePlane& plane, const PointPairs& pairs,
                        double threshold_px);

}  // namespace lowlap
