#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/rotations/scene_rotations.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// 1 + the number of alternatives.
std::size_t NumHypotheses(const RelativePose& pose);

/// The pose with its n-th motion and no alternatives; 0 is its own.
RelativePose WithHypothesis(const RelativePose& pose, std::size_t n);

/// How far another motion is from the pose's own at most, in rotation or
/// direction, in radians; 0 without alternatives.
double MotionSpread(const RelativePose& pose);
/// The same in rotation alone.
double RotationSpread(const RelativePose& pose);

/// Takes the motion of the least cost, and drops all others, if these cost more
/// by `margin` at least. `costs` has NumHypotheses entries. Otherwise the pose
/// stays as it is, and the grounds of the decision are kNone.
HypothesisDecision ChooseHypothesis(const std::vector<double>& costs,
                                    double margin, HypothesisGrounds grounds,
                                    RelativePose* pose);

/// Decides between the motions of pairs by the rotations of the scene's cycles.
///
/// Every choice of motions is averaged (AverageRotations) and costs
///   sum_e log(1 + r_e^2 / (3 sigma_e^2)),
/// over the residuals r_e of all relative rotations. sigma_e is the stated
/// deviation per axis, but least_false_deg / outlier_reach at least. A motion
/// is taken if every choice without it costs more by log(1 + outlier_reach^2)
/// at least: as much as a relative pose costs that is just an outlier. Where no
/// cycle passes, or the rotations are alike or equally far from closing any,
/// costs are alike too, and nothing is decided.
///
/// Few undecided pairs are judged all together. Where they are many, each is
/// judged on its own, while the others take part with all their motions, until
/// that decides no more. The result does not depend on the number of threads.
/// Returns what was decided.
///
/// Errors, with the scene unchanged: those of AverageRotations; kCancelled.
Result<std::vector<HypothesisDecision>> DecideHypothesesByCycles(
    Scene* scene, const PoseOptions& options, const RunContext& context);

}  // namespace lowlap
