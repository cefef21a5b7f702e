#pragma once

#include <cstdint>
#include <map>

#include "lowlap/core/internal/random.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/features/internal/features.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

// What the simulator does not make worse. Relative poses state the evidence of
// the matches that they have then.

/// Every match becomes one of features that have nothing to do with each other:
/// the points of a view change places, and so do its segments.
void ShuffleFeatures(Random* random, Scene* scene);

/// Every match becomes one of features drawn anywhere in the image: views of
/// unrelated places.
void DrawFeatures(Random* random, Scene* scene);

/// Two views of places that look alike: one relative pose, drawn, becomes any
/// motion, with up to `num_points` matches of its own that bear it out to the
/// noise, in place of those it had.
void AddLookAlikes(int num_points, double noise_px, Random* random,
                   Scene* scene);

/// The relative poses estimated anew from their matches with the intrinsics
/// that the scene has, as those of photographs are; tracks are built anew.
/// Pairs whose matches give none are gone. Errors: those of
/// EstimateRelativePoses.
Status EstimatePosesAnew(const RunContext& context, Scene* scene);

/// All pairs of views matched anew, as photographs are: by what looks the same
/// in `detected`, which has the features of all views. Relative poses and
/// tracks are those of the matches. Errors: those of MatchFeatures and
/// EstimateRelativePoses.
Status MatchAnew(const std::map<ViewId, DetectedFeatures>& detected,
                 const RunContext& context, Scene* scene);

}  // namespace lowlap
