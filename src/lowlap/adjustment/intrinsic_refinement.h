#pragma once

#include <string>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Sets options->refine_intrinsics for every intrinsic of the scene that has
/// parameters (not for panoramas). Where the distortion is to be refined, a
/// pinhole becomes a kRadialK1 without distortion, which is the same camera.
void RefineAllIntrinsics(const IntrinsicRefinement& refinement, Scene* scene,
                         AdjustmentOptions* options);

/// How far the image of a viewing ray moves, in pixels, from the intrinsics of
/// one scene to those of the other: the largest value over the corners and the
/// middles of the sides of all intrinsics that both have.
double LargestIntrinsicShiftPx(const Scene& before, const Scene& after);

/// "focal 2759.5, 2764.2 -> ..., k1 0 -> -0.02": one line per intrinsic that
/// differs between the two scenes.
std::vector<std::string> DescribeIntrinsicChanges(const Scene& before,
                                                  const Scene& after);

}  // namespace lowlap
