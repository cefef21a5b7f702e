#pragma once

#include <vector>

#include "lowlap/averaging/reliability/internal/expected_overlap.h"
#include "lowlap/averaging/reliability_warning.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// WarningReason::kMissingMatches: views whose places would have them see what
/// others see, though they were compared with these in vain. Nothing that was
/// measured speaks against a false relative pose that alone joins two parts of
/// a scene, as between the two facades of a house that look alike; what is not
/// there does.
///
/// A pair is missing if it is one of Scene::unrelated_pairs, both cameras
/// should see two fifths of what the other does (OverlapPredictor), and of that
/// hardly anything is found in both: less than a tenth of what the median pair
/// with a relative pose that agrees finds. Across the cut of least evidence
/// between its two views (WeakCuts), the pairs are counted that should share as
/// much: if at least three are missing, and more than are not, the smaller side
/// is named; both, where the other is hardly larger.
///
/// Where the cameras are right, photographs that share as much are related, by
/// a relative pose or by tracks through others, so that few missing pairs say
/// much. A scene that does not say what was compared, or has no structure, has
/// no warning. Cost: the pairs compared in vain and the relative poses, and a
/// cut for each that is missing and across none that is named.
///
/// Enough false matches between long tracks join these over the whole of two
/// places: their pairs then are not missing.
std::vector<ReliabilityWarning> FindMissingMatches(
    const Scene& scene, const PoseSummary& summary,
    const ExpectedOverlaps& overlaps);

}  // namespace lowlap
