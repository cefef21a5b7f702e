#pragma once

#include <map>
#include <vector>

#include "lowlap/adjustment/adjustment_options.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/measure_images.h"
#include "lowlap/pipeline/solve_scene.h"
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

/// MeasureImages for a scene that SolveScene is to solve with `solve` and with
/// these parts of the intrinsics free. Relative poses from a wrong focal length
/// are wrong themselves: if a first solution moves the intrinsics by more than
/// a pixel, they are estimated once more with the refined ones, which the scene
/// then has. Views without a relative pose are named in the log, with a
/// warning. Errors: those of MeasureImages; kInsufficientData, with the reason,
/// if no pair has a relative pose; kCancelled.
Result<ImageReport> MeasureAndRefine(Scene* scene,
                                     const MeasurementOptions& options,
                                     const SolveOptions& solve,
                                     const IntrinsicRefinement& refinement,
                                     const RunContext& context,
                                     StageLog* stages);

}  // namespace lowlap
