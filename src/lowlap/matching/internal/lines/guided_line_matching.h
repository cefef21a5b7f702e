#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/matching/guided_match_options.h"
#include "lowlap/matching/internal/lines/line_matching.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// Segment matches under a known relative pose (at unit baseline), sorted.
///
/// `first_normalized`, `second_normalized` hold the same segments undistorted.
/// `seeds`: matches found without the pose; those that the pose contradicts
/// are dropped, the others take part with an advantage over new ones.
///
/// A candidate is a pair of segments of the same polarity whose epipolar
/// transfers overlap, whose line lies in front of both cameras, and whose
/// descriptors are not too far apart. Its score grows with the similarity, the
/// overlap and the agreement with the candidates around it, by relaxation:
/// neighbours in the image that lie at the depth of one common surface.
/// Conflicts are resolved by score; a match that is hardly better than
/// one that contradicts it is not made.
///
/// A segment may have several partners if these are collinear pieces of one
/// broken edge that lie one behind the other: every match of a piece is listed.
std::vector<FeatureMatch> MatchLinesGuided(
    const DescribedLines& first, const DescribedLines& second,
    const NormalizedFeatures& first_normalized,
    const NormalizedFeatures& second_normalized,
    const RigidTransform& cam2_from_cam1,
    const std::vector<FeatureMatch>& seeds, const GuidedLineOptions& options);

}  // namespace lowlap
