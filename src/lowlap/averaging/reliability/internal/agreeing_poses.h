#pragma once

#include "lowlap/averaging/scene_poses.h"
#include "lowlap/scene/scene.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {

/// The placed views, and the relative poses in use that agree with their
/// places.
ViewGraph AgreeingPoses(const Scene& scene, const PoseSummary& summary);

}  // namespace lowlap
