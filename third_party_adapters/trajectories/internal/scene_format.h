#pragma once

#include "lowlap/io/scene_format.h"

namespace lowlap::trajectories {

/// Poses alone: "tum" (*.tum) and "kitti" (*.kitti), each also told by its
/// first line.
SceneFormats TrajectoryFormats();

}  // namespace lowlap::trajectories
