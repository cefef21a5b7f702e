#pragma once

#include <vector>

#include "lowlap/scene/relative_pose.h"
#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "lowlap/two_view/internal/shuffled_matches.h"

namespace lowlap {

/// log10 NFA of a pose as it is for some of the matches of a pair (indices of
/// `matches.pairs`), whose threshold may be twice that of the pose. Infinite
/// for too few of them.
double EvidenceOfSome(const TwoViewInput& input, const ShuffledMatches& matches,
                      const std::vector<int>& some, const RelativePose& pose,
                      const TwoViewOptions& options);

/// The same for matches that lie apart: the first of those, in their random
/// order, that lie in both images closer to each other than a fiftieth of the
/// image's mean side. Things that look alike, such as two corners of a shelf,
/// bear several matches side by side, which agree without saying anything of
/// the motion.
double ScatteredEvidence(const TwoViewInput& input,
                         const ShuffledMatches& matches,
                         const RelativePose& pose,
                         const TwoViewOptions& options);

}  // namespace lowlap
