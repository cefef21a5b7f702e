#pragma once

#include <cstddef>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// How one subset of the views came out. Errors are those of EvaluatePoses, in
/// the truth's unit.
struct SubsetOutcome {
  std::vector<ViewId> dropped;  // sorted
  int num_views = 0;            // that remain
  int num_placed = 0;
  double mean_error = 0;
  double max_error = 0;
  ViewId worst_view = kInvalidId;
  double mean_error_before_adjustment = 0;
  /// Of the placed cameras, by their grade (GradeViews), where they have one:
  /// RobustPositionErrors in the truth's unit. One that is far off does not
  /// move the others, as it does in the errors above.
  std::map<ViewId, double> firm_errors, doubtful_errors;
  /// The solution was flagged without knowing the truth
  /// (PoseSummary::IsDoubtful), and for what: DoubtCodes.
  std::vector<std::string> doubts;
  /// Why there is no solution at all; else empty.
  std::string failure;
  double seconds = 0;
};

/// What makes a solution doubtful, as words: "open_loop", "weak_ratio" and the
/// reasons of ViewDoubts; empty if it is not (PoseSummary::IsDoubtful).
std::vector<std::string> DoubtCodes(const PoseSummary& summary);

/// Every way to leave out `num_dropped` of the scene's views, in lexicographic
/// order; if `sample` > 0, that many of them, drawn with `seed`.
///
/// Errors: kInvalidArgument unless 0 < num_dropped and at least three views
/// remain, or if there are more than a million and no sample is asked for.
Result<std::vector<std::vector<ViewId>>> ChooseSubsets(const Scene& scene,
                                                       int num_dropped,
                                                       std::size_t sample,
                                                       std::uint64_t seed);

/// Solves the scene once for every entry of `dropped` without these views
/// (WithoutViews, SolveScene) and compares the poses with the truth, which has
/// no part in the solution. Measurements are reused; so are scale ratios: a
/// ratio depends on its triplet alone, so it is estimated once, over the whole
/// scene, unless the choice of a motion changes its triplet.
///
/// Subsets are solved in parallel on the context's threads, each on one of
/// them. `done` receives each outcome when it is there, from one thread at a
/// time, in no fixed order; its error ends the run. A subset that cannot be
/// solved is an outcome with `failure`.
///
/// Errors: invalid options, those of EstimateScaleRatios and of `done`,
/// kCancelled.
Status RunSubsets(const Scene& scene, const GroundTruth& truth,
                  const std::vector<std::vector<ViewId>>& dropped,
                  const SolveOptions& options, const RunContext& context,
                  const std::function<Status(const SubsetOutcome&)>& done);

}  // namespace lowlap
