#pragma once

#include "lowlap/averaging/rotations/scene_rotations.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Holds every relative pose of the scene against its own matches, before
/// anything is solved (CheckDirection), and puts the direction that they bear
/// out in the place of one that they contradict. Directions closer than what
/// `options` call false are one. Poses with alternatives pass: what decides
/// between these sees more than their matches. A pose of a view without an
/// intrinsic or features is untold like one of too few matches; if all are,
/// and no points are matched at all, none is listed.
///
/// Errors, with the scene unchanged: kCancelled.
Result<MatchVerdicts> CheckDirections(Scene* scene, const PoseOptions& options,
                                      const RunContext& context);

}  // namespace lowlap
