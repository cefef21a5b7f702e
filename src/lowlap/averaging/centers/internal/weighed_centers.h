#pragma once

#include <vector>

#include "lowlap/averaging/centers/internal/scene_centers.h"

namespace lowlap {

struct WeighedCenters {
  SceneCenters centers;
  std::vector<Contest> contests;  // those that cannot be decided
};

/// The centres against which least speaks. SolveSceneCenters follows robust
/// weights, which know the deviations of directions and not how much evidence a
/// relative pose has, so that a false one may keep two right ones out; nor does
/// it take in again what only a false one contradicted. Where relative poses
/// contradict it, the scene is therefore solved in other ways (SearchSides),
/// from both of its starts, and where ratios are vague
/// (DiagnosisOptions::max_stddev), from both once more with these for views
/// only that nothing else places: such a ratio gives a part of the scene a
/// false scale to start from, which a loop would tell better. That against
/// which the least evidence speaks is taken, of those that place most views.
///
/// Cost: that of one to four searches. Errors: those of SolveSceneCenters.
Result<WeighedCenters> SolveWeighedCenters(const Scene& scene,
                                           const SceneRotations& rotations,
                                           const PoseOptions& options,
                                           const RunContext& context);

}  // namespace lowlap
