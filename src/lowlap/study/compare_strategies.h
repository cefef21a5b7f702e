#pragma once

#include <cstddef>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/averaging/averager_registry.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

struct CompareOptions {
  /// Where strategies come from; register your own there.
  AveragerRegistry registry = AveragerRegistry::WithBuiltIns();
  /// As the registry reads them; "all" stands for all its names. Repeated ones
  /// count once.
  std::vector<std::string> strategies = {"all"};
  /// Everything but the strategy, which is not read.
  SolveOptions solve;
  /// The solution of this strategy is what the others are compared with; if it
  /// does not take part, or fails, the first that places cameras.
  std::string reference = "graph";
  /// True cameras to judge by; never used for solving.
  std::optional<GroundTruth> truth;

  /// The known strategies are listed for an unknown one.
  Status Validate() const;
};

/// How well poses and structure agree with what they were computed from: what
/// can be said without true cameras.
struct Consistency {
  /// Angles between the direction of a relative pose (i, j) and that of the
  /// solved baseline, R_j (C_i - C_j), in degrees.
  ErrorStatistics direction_deg;
  double mean_baseline = 0;  // of the same relative poses, world units
  /// | log(|C_k - C_j| / |C_j - C_i|) - log ratio | of the meaningful scale
  /// ratios (i, j, k); 0.01 is about 1 per cent of scale. Parts that were put
  /// together at an arbitrary scale show here, and not in the directions.
  ErrorStatistics abs_log_ratio;
  /// Of the points of the structure, over all their observations, pixels.
  std::size_t num_points = 0;
  double reprojection_rmse_px = 0;
};

/// A solution at one point of the way: as averaged, or as adjusted.
struct SolutionQuality {
  Consistency consistency;
  /// Only if there is a truth.
  std::optional<PoseEvaluation> errors;
  /// Positions against the reference's, after a similarity alignment of the
  /// cameras placed by both, in mean baselines of the reference. Absent for the
  /// reference itself, and for fewer than three common cameras.
  std::optional<ErrorStatistics> difference;
};

/// What one strategy made of the problem.
struct StrategyResult {
  std::string strategy;
  /// The strategy gave no solution, or its solution could not be adjusted.
  std::optional<Error> failure;
  /// Why cameras are missing, in words; empty if all are placed.
  std::string limit;
  /// Cameras with a common scale: those of the largest component, which is the
  /// one that is adjusted and judged.
  int num_placed = 0;
  int num_components = 0;
  std::vector<ViewId> unplaced;
  int num_iterations = 0;
  SolutionQuality before;
  std::optional<SolutionQuality> after;  // if adjusted
  std::map<PoseId, Pose> poses_before_adjustment;
  std::map<PoseId, Pose> poses;  // the last ones
  int num_adjustment_iterations = 0;
  /// "averaging", "structure", "adjustment", as far as they were reached.
  std::vector<StageCost> costs;
};

/// All strategies on one input.
struct Comparison {
  int num_views = 0;
  int num_edges = 0;   // relative poses in the problem
  int num_ratios = 0;  // meaningful scale ratios in the problem
  int num_outlier_edges = 0;
  bool has_truth = false;
  std::string reference;                // empty if no strategy placed cameras
  std::vector<StrategyResult> results;  // in the order asked for
  std::vector<StageCost> shared_costs;  // "rotations", "scale ratios"
};

/// Runs every strategy on the same TranslationProblem: the scene's motions,
/// rotations, choice of relative poses and scale ratios are found once
/// (StartSolution, EstimateBelievedRatios), then each strategy places the
/// cameras, and structure and bundle adjustment follow from its poses alone.
/// Unlike in SolveScene, directions that contradict the solved centres stay in,
/// and ratios that are not meaningful stay out: strategies are compared, not
/// what repairs their input.
///
/// A strategy that fails, or places few cameras, is a result with its reason.
/// Everything but the costs is the same for any number of threads.
///
/// Errors: kInvalidArgument (options, an unknown strategy: before anything is
/// computed), those of the shared stages, kCancelled.
Result<Comparison> CompareStrategies(const Scene& scene,
                                     const CompareOptions& options,
                                     const RunContext& context);

/// A table for people, a row per strategy, and below it why cameras are
/// missing. Position errors are in the truth's unit, or, without a truth,
/// differences to the reference strategy in mean baselines.
std::string ToText(const Comparison& comparison);

/// One record per strategy. Cells of what there is not are empty. The columns
/// whose names end in "_s" are times and differ from run to run; they are the
/// last ones. All others are the same in every run.
std::string ToCsv(const Comparison& comparison);

/// The members of Comparison; times are in objects named "cost".
std::string ToJson(const Comparison& comparison, const Scene& scene);

/// Plots as SVG documents with their file names: position errors before and
/// after adjustment (with a truth; else the differences to the reference),
/// cameras placed, how well the relative poses and ratios are met, times.
Result<std::vector<std::pair<std::string, std::string>>> DrawComparison(
    const Comparison& comparison);

/// Makes the folder and writes compare.csv, compare.json and the plots into it,
/// each whole or not at all. A plot that an earlier comparison left, and this
/// one does not have, is removed.
Status WriteComparison(const Comparison& comparison, const Scene& scene,
                       const std::string& folder);

}  // namespace lowlap
