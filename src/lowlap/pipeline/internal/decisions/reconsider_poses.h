#pragma once

#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Estimates relative poses of few matches again, with what the rest of the
/// scene says about their rotations (InformPose).
///
/// The prior of a pair is the rotation along the most certain path between its
/// views that avoids it, with the deviations that those of the path add up to;
/// to each of these, as stated, least_false_deg / outlier_reach is added, and
/// how far the motions of an undecided pair are apart; a pose that states none
/// is on no path. A pair takes its new motion if that gains a decimal digit, as
/// it does by the prior alone, and agrees with its prior (in 95 of 100 cases).
/// Of pairs that are on one another's paths the one that gains most goes first,
/// and the others are looked at again: one wrong pair bends the paths of many.
/// A pair whose own matches tell its motion has nothing to gain, and one on no
/// cycle no prior. Alternatives of a pair that takes another motion are
/// dropped. The result does not depend on the number of threads.
///
/// Errors, with the scene unchanged: kCancelled.
Result<std::vector<ReconsideredPose>> ReconsiderPoses(
    Scene* scene, const PoseOptions& options, const RunContext& context);

}  // namespace lowlap
