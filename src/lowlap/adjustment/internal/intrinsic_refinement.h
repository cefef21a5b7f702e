#pragma once

#include <string>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/adjustment/adjustment_summary.h"
#include "lowlap/core/result.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Sets options->refine_intrinsics for every intrinsic of the scene that has
/// parameters (not for panoramas). Where the distortion is to be refined, a
/// pinhole becomes a kRadialK1 without distortion, which is the same camera; it
/// stays in scene->given_intrinsics.
void RefineAllIntrinsics(const IntrinsicRefinement& refinement, Scene* scene,
                         AdjustmentOptions* options);

/// Back to scene->given_intrinsics, which is empty then: what starts from the
/// measurements of an adjusted scene starts from their calibration.
void RestoreGivenIntrinsics(Scene* scene);

/// IntrinsicShiftPx from the given intrinsics to the present ones: of all
/// intrinsics, the largest.
double LargestIntrinsicShiftPx(const Scene& scene);

/// "focal 2759.5, 2764.2 -> ...; distortion 0 -> -0.02": one line for every
/// intrinsic that is not the given one.
std::vector<std::string> DescribeIntrinsicChanges(const Scene& scene);

/// "focal,aspect", as --refine-intrinsics takes it; empty for none.
std::string DescribeParts(const IntrinsicRefinement& refinement);
/// Back from it; "all" is known, too. kInvalidArgument, with what is known, for
/// another word.
Result<IntrinsicRefinement> ParseRefinement(const std::string& parts);
/// What is not named.
IntrinsicRefinement Others(const IntrinsicRefinement& refinement);

/// "the images prefer ... to the calibration of intrinsic 0 that is held (5.3
/// deviations): focal 2759.5, 2764.2 -> ...; --refine-intrinsics focal follows
/// them".
std::vector<std::string> DescribeCalibrationPreferences(
    const AdjustmentSummary& summary);

}  // namespace lowlap
