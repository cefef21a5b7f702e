#pragma once

#include <vector>

#include "lowlap/averaging/centers/internal/scene_centers.h"

namespace lowlap {

/// FindContests among the placed views of a scene. Relative poses whose own
/// matches do not bear them out, or that are off by a little only, contradict
/// nothing; what is contested as a link of the rotations already is not again.
std::vector<Contest> FindSceneContests(const Scene& scene,
                                       const SceneRotations& rotations,
                                       const SceneCenters& centers);

}  // namespace lowlap
