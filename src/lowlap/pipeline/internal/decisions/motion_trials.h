#pragma once

#include <cstddef>
#include <limits>
#include <optional>
#include <vector>

#include "lowlap/adjustment/internal/rounds/optimum_search.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// One of the motions that explain a pair, tried in the whole scene.
struct MotionTrial {
  ViewPair views;
  std::size_t motion = 0;  // WithHypothesis; 0: all stays as it is
  /// What went wrong, if anything did.
  Status status;
  /// The scene with its ratios and poses under this motion, which comes first
  /// in the pair; the pair's own has taken its place among the alternatives.
  Scene scene;
  RatioSummary ratios;
  PoseSummary poses;
  std::optional<Optimum> optimum;
  /// MeasurementCost of the optimum, at the noise of the first trial.
  double cost = std::numeric_limits<double>::infinity();
};

/// Composes the scene of the first trial, which stays as it is, under the
/// motions of the others (EstimateBelievedRatios, ComposePoses), and adjusts
/// each from there (OptimumSearch::Run). Relative poses that contradict the
/// solution under every motion have no say (BelievedEvidence); what only some
/// contradict may be what tells. A trial that fails, or that places other views
/// than the first, has an error and no cost.
///
/// `rotations`: those of the first trial, whose verdicts hold in all. The
/// result does not depend on the number of threads. Error: kCancelled.
Status RunMotionTrials(const SceneRotations& rotations,
                       const SolveOptions& options, const RunContext& context,
                       std::vector<MotionTrial>* trials);

}  // namespace lowlap
