#pragma once

#include <map>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/internal/measure/relate_and_refine.h"
#include "lowlap/pipeline/measure_images.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// What the photographs gave.
struct ImageReport {
  std::vector<PairReport> pairs;
  std::vector<UnrelatedView> unrelated;
  /// All features, of which the scene keeps those with a match.
  std::map<ViewId, ViewFeatures> detected;
};

/// MeasureImages, with the intrinsics that a first solution refines
/// (RelateAndRefine). Views without a relative pose are named in the log, with
/// a warning. Errors: those of MeasureImages; kInsufficientData, with the
/// reason, if no pair has a relative pose; kCancelled.
Result<ImageReport> MeasureAndRefine(Scene* scene,
                                     const MeasurementOptions& options,
                                     const FirstSolution& first,
                                     const RunContext& context,
                                     StageLog* stages);

}  // namespace lowlap
