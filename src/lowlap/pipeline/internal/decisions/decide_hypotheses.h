#pragma once

#include <vector>

#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scale/scale_estimator.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Decides between the motions of pairs by the scale ratios of their triplets.
///
/// Points of a plane that two motions explain lie on two different planes under
/// them. Only the right one agrees with what the neighbouring pairs see of it,
/// at any ratio. A motion costs the sum of log10 NFA of the ratios that it
/// leads to, over the triplets through the pair (with the neighbours of most
/// evidence, where there are many); a neighbour that is itself undecided takes
/// the motion that suits best. A motion is taken if every other one costs more
/// by 10, and by a tenth of its own cost at least.
///
/// The result does not depend on the number of threads. Returns what was
/// decided.
///
/// Errors: those of EstimateScaleRatios.
Result<std::vector<HypothesisDecision>> DecideHypothesesByTriplets(
    Scene* scene, const ScaleEstimator& estimator, const RunContext& context);

/// Settles the alternatives of the scene's relative poses by cycles
/// (DecideHypothesesByCycles) and, where these do not decide, by triplets, in
/// turns until neither decides any more. The motion taken replaces the pose's
/// own; where nothing decides, the pose and its alternatives stay. One entry
/// per pair that had alternatives, by views; the log is left to LogDecisions.
Result<std::vector<HypothesisDecision>> DecideHypotheses(
    Scene* scene, const ScaleEstimator& scale, const PoseOptions& poses,
    const RunContext& context);

/// Says which motions were taken, and warns of pairs that nothing decided.
void LogDecisions(const std::vector<HypothesisDecision>& decisions,
                  const Scene& scene, const RunContext& context);

}  // namespace lowlap
