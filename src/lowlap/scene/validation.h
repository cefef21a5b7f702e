#pragma once

#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Checks that a scene does not contradict itself: every id refers to
/// something (views, intrinsics, poses, features, tracks, lines), numbers are
/// finite, rotations are rotations (to 1e-6), directions are unit, pairs are
/// ordered, tracks have at least two observations and no repeated one.
///
/// The first violation comes back as kInvalidScene whose `place` is the path of
/// the offending value in the JSON form of the scene (sfm_data/FORMAT.md).
Status ValidateScene(const Scene& scene);

}  // namespace lowlap
