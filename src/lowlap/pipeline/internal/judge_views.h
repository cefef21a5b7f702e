#pragma once

#include <optional>

#include "lowlap/adjustment/adjustment_summary.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scale/scale_estimator.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Doubts about the placed views once more, in the light of the structure and,
/// if there was one, of the adjustment: the summary's reliability warnings,
/// firm evidence and weak ratios. What measurements hardly tell may be told by
/// the adjusted cameras: their directions and ratios with what is left open of
/// them, what the structure predicts (FindPredictionEvidence), and weak ratios
/// as they are measured between them. Features that do not fit and matches that
/// are missing make views doubtful (FindLostFeatures, FindMissingMatches), and
/// so do look-alikes that are in use (FindLookAlikes,
/// PoseSummary::look_alikes). What nothing else doubts is doubted where its
/// stated deviations ask for it (FindImpreciseViews). `scene` holds the
/// solution, and is as it was in the end.
///
/// Errors: those of EstimateScaleRatios.
Status JudgeViews(Scene* scene,
                  const std::optional<AdjustmentSummary>& adjustment,
                  const ScaleEstimator& estimator, const RunContext& context,
                  PoseSummary* poses);

}  // namespace lowlap
