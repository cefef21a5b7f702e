#pragma once

#include <vector>

#include "lowlap/averaging/centers/internal/scene_centers.h"

namespace lowlap {

/// FindContests among the placed views of a scene, with what third views leave
/// of the evidence (ThirdViewVerdicts::evidence). Relative poses whose own
/// matches do not bear them out, or that are off by a little only, contradict
/// nothing; what is contested as a link of the rotations already is not again.
std::vector<Contest> FindSceneContests(const Scene& scene,
                                       const SceneRotations& rotations,
                                       const SceneCenters& centers);

/// Those that stay in the light of poses that were adjusted since. What a
/// contradiction says may be what the adjustment found: those that the poses of
/// the scene meet, to within what a little is (kLittleDeg), contradict nothing
/// any more, and the others contest as before, if they have more than half the
/// evidence.
std::vector<Contest> ContestsThatStay(const Scene& scene,
                                      const std::vector<Contest>& contests);

}  // namespace lowlap
