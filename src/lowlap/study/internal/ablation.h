#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

struct AblationOptions {
  /// What is not varied: strategy, adjustment without its ties (coplanar kind
  /// and directions), and of the scale options all but criterion, threshold and
  /// kinds of features.
  SolveOptions solve;
  ScaleOptions scale;
  /// Inlier thresholds to set against the a-contrario criterion, pixels.
  std::vector<double> thresholds_px = {0.5, 1, 3, 6, 9};

  Status Validate() const;
};

/// One way to estimate the scale ratios and to adjust, and the cameras that
/// come of it.
struct AblationCase {
  /// "0.5 px", "a contrario", "points", "all + adjustment", "planes"
  std::string name;
  ScaleOptions scale;
  bool adjusted = false;
  /// The case has no solution; what follows the ratios is empty then.
  std::optional<Error> failure;
  RatioSummary ratios;
  ErrorStatistics abs_log_ratio;  // of the meaningful ratios, to the truth
  int num_placed = 0;
  PoseEvaluation errors;
  AdjustmentSummary adjustment;  // empty if there was none
  std::vector<StageCost> costs;
};

struct Ablation {
  int num_views = 0;
  /// The thresholds in turn, then the a-contrario criterion; all features.
  std::vector<AblationCase> criteria;
  /// Points, lines, both, coplanar pairs, all, all with bundle adjustment; a
  /// contrario.
  std::vector<AblationCase> features;
  /// All features, a contrario: before the bundle adjustment, and after it
  /// without ties, and with coplanar pairs (as in the paper), planes,
  /// directions, planes and directions.
  std::vector<AblationCase> ties;
};

/// The experiments of Salaün, Marlet, Monasse 2017, section 6 (table 1), on any
/// scene with true cameras: position errors before bundle adjustment for fixed
/// inlier thresholds against the a-contrario criterion, and for each kind of
/// feature. Besides, the errors after it by what holds it in the end (its
/// ties). Motions, rotations and the choice of relative poses are found once;
/// ratios and poses anew for each threshold and kind, and the adjustment alone
/// for each kind of ties. The truth enters no solution. Every ratio, however it
/// was found, is refined on the features that agree with it (RefineOnInliers),
/// which takes away most of what a threshold does in the paper, where the best
/// sample stands.
///
/// A case without a solution is an entry with its reason. All but the costs are
/// the same for any number of threads. Errors: kInvalidArgument (options; an
/// adjustment without lines or with free intrinsics, where ties do nothing),
/// kInsufficientData (fewer than three views with a truth), those of
/// StartSolution, kCancelled.
Result<Ablation> Ablate(const Scene& scene, const GroundTruth& truth,
                        const AblationOptions& options,
                        const RunContext& context);

/// The three tables for people.
std::string ToText(const Ablation& ablation);
/// One record per case; times last, in columns that end in "_s". A case that
/// tables share is in each.
std::string ToCsv(const Ablation& ablation);
/// The same as an object of three lists; times are in objects named "cost".
std::string ToJson(const Ablation& ablation);
/// The tables as bars: (file name, SVG document).
Result<std::vector<std::pair<std::string, std::string>>> DrawAblation(
    const Ablation& ablation);
/// Makes the folder and writes ablate.csv, ablate.json and the plots into it,
/// each whole or not at all.
Status WriteAblation(const Ablation& ablation, const std::string& folder);

}  // namespace lowlap
