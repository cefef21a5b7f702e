#pragma once

#include <vector>

#include "lowlap/averaging/internal/scene_centers.h"

namespace lowlap {

struct WeighedCenters {
  SceneCenters centers;
  std::vector<Contest> contests;  // those that cannot be decided
};

/// The centres against which least speaks. SolveSceneCenters follows robust
/// weights, which know the deviations of directions and not how much evidence a
/// relative pose has, so that a false one may keep two right ones out; nor does
/// it take in again what only a false one contradicted. Where relative poses
/// contradict it, the scene is therefore solved again: from its strongest
/// relative poses, as few as lose no view; then, for every contest
/// (FindSceneContests), with the contradictions beside the links, and with them
/// instead of the links; then without one more, the weakest first. If the
/// relative poses that contradict such a solution, left out or kept, have less
/// evidence together, and no view is lost, it is taken, and its own contests
/// are looked at next. All of that is done once more, where ratios are vague
/// (DiagnosisOptions::max_stddev), with these for views only that nothing else
/// places: such a ratio gives a part of the scene a false scale to start from,
/// which a loop would tell better.
///
/// A contest is decided, and not listed, if those that contradict only the
/// solution without the links have more than twice the evidence of those that
/// contradict only this one: that counts what else must be wrong if the links
/// are. It is not where that solution loses a view or fails, nor where a
/// contradiction is left out for its rotation, which stays as it is.
///
/// Cost, once or twice: three solutions, two for each contest, of the 3000 / n
/// (at least one) against whose links most evidence speaks, n views being
/// placed, and as many again without one. Errors: those of SolveSceneCenters.
Result<WeighedCenters> SolveWeighedCenters(const Scene& scene,
                                           const SceneRotations& rotations,
                                           const PoseOptions& options,
                                           const RunContext& context);

}  // namespace lowlap
