#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/matching/match_options.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// The line matches that are plausible under a known relative pose (at unit
/// baseline).
///
/// Two interpretation planes always meet in a line, so two views of an
/// infinite line constrain nothing; its segments do: the epipolar lines of the
/// end points of one segment cut the other line where the same 3D points must
/// appear. A match is kept if the intervals overlap enough in both views and
/// the triangulated line lies in front of both cameras over the overlap.
/// Matches that cannot be judged (a segment in an epipolar plane, an invalid
/// segment) are dropped.
std::vector<FeatureMatch> FilterLineMatches(
    const std::vector<FeatureMatch>& matches, const NormalizedFeatures& first,
    const NormalizedFeatures& second, const RigidTransform& cam2_from_cam1,
    const LineFilterOptions& options);

}  // namespace lowlap
