#pragma once

#include "lowlap/scene/features.h"
#include "lowlap/scene/relative_pose.h"

namespace lowlap {

/// Whether what lies around the matches of a pair matches as well, as it does
/// where both views see one place, and does not where two things look alike:
/// two benches of one make agree on a motion as one bench does, with any
/// evidence, but behind each is a wall of its own. Missing matches tell (Zach,
/// Irschara, Bischof, "What can missing correspondences tell us about 3D
/// structure and motion?", CVPR 2008).
///
/// Either view is divided into squares of a tenth of its diagonal. A square
/// with inliers has the median depth of these, another that of the inlier
/// nearest to its centre; its features ought to be seen by the other view where
/// they are then in front of it and within the box of its features. With p the
/// share of these that are inliers in the squares that have any, a square
/// without inliers is missing if two or more of its features should have been.
///
/// Of what both see, most should match, whatever is hidden or seen too
/// obliquely: the result is log10 P(X <= present), X binomial of all squares of
/// both views that are present or missing, each with chance 1/2. 0 without
/// inliers.
///
/// It is no proof: of a room that is seen through a door, the matches are few
/// and what surrounds them is hidden. `features` are all that were detected,
/// those without matches too.
double Log10ChanceOfSurroundings(const NormalizedFeatures& features1,
                                 const NormalizedFeatures& features2,
                                 const RelativePose& pose);

}  // namespace lowlap
