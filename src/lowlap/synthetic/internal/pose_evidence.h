#pragma once

#include "lowlap/scene/scene.h"

namespace lowlap {

/// log10 NFA that the point matches of a relative pose give it: the least of
/// AContrarioLadder for their Sampson residuals, from samples of five points
/// and against uniform chance. 0 where chance explains them, or where there are
/// no more than five. `scene` holds the features and intrinsics of both views.
double PointEvidence(const Scene& scene, const RelativePose& pose);

/// All relative poses of the scene state that evidence.
void StatePointEvidence(Scene* scene);

}  // namespace lowlap
