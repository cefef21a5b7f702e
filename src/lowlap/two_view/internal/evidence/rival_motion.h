#pragma once

#include <vector>

#include "lowlap/matching/internal/points/guided_point_matching.h"
#include "lowlap/scene/features.h"
#include "lowlap/scene/relative_pose.h"

namespace lowlap {

/// log10 NFA of a motion that the look of other places bears out, with the
/// rotation of the pose.
///
/// Along a corridor of equal doors a point of one view looks like several
/// places of the other one, and each step from door to door is a motion that
/// explains some of them. Which the matches are of is a matter of the angle at
/// which the doors are seen. So of 256 at most of the `inliers`, evenly spaced,
/// either point is compared with the other view's points outside the window of
/// its match: the four that look most like it, one of each part of the image
/// and no more than twice as far as the match, are its places. A motion (R, t),
/// R the pose's rotation, explains those in front of both views whose
/// epipolar plane is within twice the pose's threshold of the ray:
///   x2 . (t x R x1) = 0.
/// Two places determine t. That k of n points have a place that it explains has
///   NFA = M^2 C(n, k) C(k, 2) p^(k - 2),
/// M places, p the expected number of places of a point that it explains with
/// partners drawn at random: where points crowd along epipolar lines, many are.
///
/// 0 where no motion is meaningful, or places have no parallax. The same for
/// the same input.
double Log10NfaOfRivalMotion(const PointView& first, const PointView& second,
                             const RelativePose& pose,
                             const std::vector<FeatureMatch>& inliers);

}  // namespace lowlap
