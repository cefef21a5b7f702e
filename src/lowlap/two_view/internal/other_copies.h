#pragma once

#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "lowlap/two_view/internal/shuffled_matches.h"

namespace lowlap {

/// Which of the matches and crossings that belong to a pattern join two
/// different copies, as far as the plane tells that holds most inliers of the
/// pose which belong to none (MatchesBeyondRepeats): its homography takes the
/// point of one view not to its match, but to another copy of it
/// (RepeatedPattern::AreCopies), to within a tenth of the way between the two,
/// or 3 px. One window after the other of a facade agrees on such a step as on
/// a plane behind it, and a pose of little parallax gives way to that.
///
/// Of n that belong to a pattern and lie off the plane, k are such copies by
/// chance with NFA = C(n, k) p^k, p the share with partners drawn at random.
/// Indices of `matches.pairs`, ascending; none unless NFA < 0.001, where
/// nothing is known to repeat, or where no plane holds ten inliers.
std::vector<int> MatchesOfOtherCopies(const TwoViewInput& input,
                                      const ShuffledMatches& matches,
                                      const RelativePose& pose, Random& random);

}  // namespace lowlap
