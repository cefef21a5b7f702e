#include "lowlap/study/internal/ablation.h"

#include <array>
#include <cstddef>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/requirement.h"
#include "lowlap/evaluation/internal/relative_errors.h"
#include "lowlap/pipeline/internal/decisions/decide_hypotheses.h"
#include "lowlap/report/internal/table_text.h"
#include "lowlap/scale/evidence/evidence_registry.h"

namespace lowlap {
namespace {

struct Features {
  const char* name;
  std::vector<std::string> words;
};

// The last is that of all.
std::vector<Features> FeatureCases() {
  return {{"points", {"points"}},
          {"lines", {"lines"}},
          {"points + lines", {"points", "lines"}},
          {"coplanar", {"coplanar"}},
          {"all", EvidenceRegistry::BuiltIn().Features()}};
}

// What holds the end of the bundle adjustment.
struct Ties {
  const char* name;
  bool use_coplanar;
  CoplanarTies coplanar;
  bool use_directions;
};

// The last are those of AdjustmentOptions.
constexpr std::array<Ties, 5> kTies = {
    {{"none", false, CoplanarTies::kPlanes, false},
     {"pairs", true, CoplanarTies::kPairs, false},
     {"planes", true, CoplanarTies::kPlanes, false},
     {"directions", false, CoplanarTies::kPlanes, true},
     {"planes + directions", true, CoplanarTies::kPlanes, true}}};

AblationCase MakeCase(std::string name, const Features& features,
                      ScaleCriterion criterion, ScaleOptions scale) {
  AblationCase made;
  made.name = std::move(name);
  scale.features = features.words;
  scale.criterion = criterion;
  made.scale = scale;
  return made;
}

/// Runs cases from a common start.
class Runner {
 public:
  Runner(const Scene& scene, const SolveStart& start, const GroundTruth& truth,
         const SolveOptions& options, const RunContext& context)
      : scene_(scene),
        start_(start),
        truth_(truth),
        options_(options),
        context_(context) {}

  /// Ratios and poses; returns the scene as solved.
  Scene Run(AblationCase* entry) const {
    Scene scene = scene_;
    StageLog stages;
    SolveOptions options = options_;
    options.scale_estimator = MakeScaleEstimator(entry->scale);
    const Status status = Solve(options, &scene, entry, &stages);
    if (!status) entry->failure = status.error();
    entry->costs = stages.stages();
    return scene;
  }

  /// The structure of a solved case, for all its adjustments.
  void AddStructure(AblationCase* entry, Scene* scene) const {
    RunStage("structure", entry, [&]() -> Status {
      LOWLAP_RETURN_IF_ERROR(
          BuildStructure(scene, options_.structure, context_));
      return {};
    });
  }

  /// The bundle adjustment of a case with structure.
  AblationCase Adjust(AblationCase entry, const Ties& ties, Scene scene) const {
    entry.name = ties.name;
    entry.adjusted = true;
    AdjustmentOptions options = options_.adjustment;
    options.use_coplanar = ties.use_coplanar;
    options.coplanar_ties = ties.coplanar;
    options.use_directions = ties.use_directions;
    RunStage("adjustment", &entry, [&]() -> Status {
      LOWLAP_ASSIGN_OR_RETURN(entry.adjustment,
                              AdjustScene(&scene, options, context_));
      entry.errors = EvaluatePoses(scene, truth_);
      return {};
    });
    return entry;
  }

 private:
  Status Solve(const SolveOptions& options, Scene* scene, AblationCase* entry,
               StageLog* stages) const {
    LOWLAP_ASSIGN_OR_RETURN(
        entry->ratios,
        EstimateBelievedRatios(scene, start_, options, context_, stages));
    entry->abs_log_ratio = EvaluateScaleRatios(*scene, truth_).abs_log_error;
    LOWLAP_ASSIGN_OR_RETURN(
        const auto poses,
        ComposePoses(scene, start_.rotations, options.poses, context_, stages));
    entry->num_placed = poses.num_placed;
    entry->errors = EvaluatePoses(*scene, truth_);
    return {};
  }

  // A stage after the poses: where it fails, there is no solution.
  static void RunStage(const char* name, AblationCase* entry,
                       const std::function<Status()>& stage) {
    if (entry->failure) return;
    StageLog stages;
    Status status;
    {
      const StageLog::Scope scope(&stages, name);
      status = stage();
    }
    entry->costs.push_back(stages.stages().front());
    if (status) return;
    entry->failure = status.error();
    entry->errors = {};
    entry->num_placed = 0;
  }

  const Scene& scene_;
  const SolveStart& start_;
  const GroundTruth& truth_;
  const SolveOptions& options_;
  const RunContext& context_;
};

AblationCase Named(const char* name, AblationCase entry) {
  entry.name = name;
  return entry;
}

bool IsCancelled(const AblationCase& entry) {
  return entry.failure && entry.failure->code == ErrorCode::kCancelled;
}

}  // namespace

Status AblationOptions::Validate() const {
  LOWLAP_RETURN_IF_ERROR(solve.Validate());
  LOWLAP_RETURN_IF_ERROR(scale.Validate());
  LOWLAP_RETURN_IF_ERROR(
      Require({{solve.adjustment.use_lines,
                "ablation: lines must be used in the adjustment"},
               {!solve.adjustment.MovesIntrinsics(),
                "ablation: intrinsics must be held"}}));
  for (const double threshold_px : thresholds_px) {
    if (!(threshold_px > 0)) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "ablation: thresholds must be positive");
    }
  }
  return {};
}

Result<Ablation> Ablate(const Scene& scene, const GroundTruth& truth,
                        const AblationOptions& options,
                        const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  std::size_t num_true = 0;
  for (const auto& entry : scene.views) num_true += truth.count(entry.first);
  if (num_true < 3) {
    return MakeError(ErrorCode::kInsufficientData,
                     "ablation: positions can be judged against three true "
                     "cameras or more; there are " +
                         std::to_string(num_true));
  }
  Scene start_scene = scene;
  StageLog stages;
  LOWLAP_ASSIGN_OR_RETURN(
      const auto start,
      StartSolution(&start_scene, options.solve, context, &stages));
  LogDecisions(start.motions, start_scene, context);

  const std::vector<Features> cases = FeatureCases();
  const Features& all = cases.back();
  Ablation ablation;
  ablation.num_views = static_cast<int>(scene.views.size());
  for (const double threshold_px : options.thresholds_px) {
    ablation.criteria.push_back(MakeCase(NumberText(threshold_px, 6) + " px",
                                         all, ScaleCriterion::kFixedThreshold,
                                         options.scale));
    ablation.criteria.back().scale.threshold_px = threshold_px;
  }
  for (const Features& features : cases) {
    ablation.features.push_back(MakeCase(
        features.name, features, ScaleCriterion::kAContrario, options.scale));
  }

  const Runner runner(start_scene, start, truth, options.solve, context);
  const std::size_t total =
      ablation.criteria.size() + ablation.features.size() + kTies.size();
  std::size_t done = 0;
  Scene solved;
  for (std::vector<AblationCase>* table :
       {&ablation.criteria, &ablation.features}) {
    for (AblationCase& entry : *table) {
      if (!context.Progress("cases", done++, total)) {
        return MakeError(ErrorCode::kCancelled, "stopped", {}, "cases");
      }
      solved = runner.Run(&entry);
      if (IsCancelled(entry)) return tl::unexpected<Error>(*entry.failure);
    }
  }
  // The last case is the one with all features.
  ablation.criteria.push_back(Named("a contrario", ablation.features.back()));
  ablation.ties.push_back(Named("before adjustment", ablation.features.back()));
  AblationCase built = ablation.features.back();
  runner.AddStructure(&built, &solved);
  if (IsCancelled(built)) return tl::unexpected<Error>(*built.failure);
  for (const Ties& ties : kTies) {
    if (!context.Progress("cases", done++, total)) {
      return MakeError(ErrorCode::kCancelled, "stopped", {}, "cases");
    }
    ablation.ties.push_back(runner.Adjust(built, ties, solved));
    const AblationCase& entry = ablation.ties.back();
    if (IsCancelled(entry)) return tl::unexpected<Error>(*entry.failure);
  }
  ablation.features.push_back(Named("all + adjustment", ablation.ties.back()));
  context.Progress("cases", total, total);
  return ablation;
}

}  // namespace lowlap
