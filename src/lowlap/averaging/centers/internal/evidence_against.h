#pragma once

#include "lowlap/averaging/scene_poses.h"

namespace lowlap {

/// The evidence of all relative poses between views with poses whose directions
/// are further off from these than `options` calls false, in use or not, or
/// whose lengths the meaningful ratios contradict (ContradictedLengths): with
/// it, solutions of one scene that leave out different ones can be compared.
double EvidenceAgainstPoses(const Scene& scene, const PoseOptions& options);

}  // namespace lowlap
