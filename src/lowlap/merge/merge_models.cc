#include "lowlap/merge/merge_models.h"

#include <set>
#include <utility>

#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/merge/internal/ties.h"
#include "lowlap/merge/internal/trusted_pieces.h"
#include "lowlap/pipeline/internal/decisions/decide_hypotheses.h"

namespace lowlap {
namespace {

Status CheckArguments(const std::vector<PartialModel>& models,
                      const std::vector<ModelCheck>& checks,
                      const SolveOptions& options) {
  if (models.empty() || models.size() != checks.size()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "a merge needs models, and a check of each");
  }
  for (std::size_t m = 0; m < models.size(); ++m) {
    if (checks[m].pieces.empty()) {
      return MakeError(ErrorCode::kInsufficientData,
                       "measurements bear out no three of its cameras",
                       models[m].name);
    }
  }
  return options.Validate();
}

// The relative poses as they were measured, with the motions that the pieces
// and the solution chose.
void RestorePoses(const std::map<ViewPair, RelativePose>& measured,
                  const std::vector<ModelCheck>& checks,
                  const std::vector<TrustedPiece>& pieces, Scene* scene) {
  std::set<ViewPair> restored;
  for (const TrustedPiece& trusted : pieces) {
    for (const PairAgreement& pair : checks[trusted.model].pairs) {
      if (trusted.piece.Holds(pair.views.first, pair.views.second) &&
          restored.insert(pair.views).second) {
        scene->relative_poses.at(pair.views) =
            WithHypothesis(measured.at(pair.views), pair.hypothesis);
      }
    }
  }
}

// Those of the pieces, which stood for the models, as they were measured.
void RestoreRatios(const std::vector<ModelCheck>& checks,
                   const std::vector<TrustedPiece>& pieces, Scene* scene) {
  std::map<ViewTriplet, const ScaleRatio*> measured;
  for (const TrustedPiece& trusted : pieces) {
    for (const ScaleRatio& ratio : checks[trusted.model].measured_ratios) {
      if (trusted.piece.Holds(ratio.views.first, ratio.views.middle) &&
          trusted.piece.Holds(ratio.views.middle, ratio.views.last)) {
        measured.emplace(ratio.views, &ratio);
      }
    }
  }
  for (ScaleRatio& ratio : scene->scale_ratios) {
    const auto found = measured.find(ratio.views);
    if (found != measured.end()) ratio = *found->second;
  }
}

}  // namespace

Result<SolveResult> MergeModels(Scene* scene,
                                const std::vector<PartialModel>& models,
                                const std::vector<ModelCheck>& checks,
                                const SolveOptions& options,
                                const RunContext& context, StageLog* stages) {
  LOWLAP_RETURN_IF_ERROR(CheckArguments(models, checks, options));
  const std::vector<TrustedPiece> pieces = TrustedPieces(*scene, checks);
  const std::map<ViewPair, RelativePose> measured = scene->relative_poses;
  TrustPieces(models, checks, pieces, scene);
  SolveOptions merging = options;
  merging.reuse_ratios = true;
  merging.reconsider_poses = false;  // those of the pieces are given

  SolveResult result;
  LOWLAP_ASSIGN_OR_RETURN(auto start,
                          StartSolution(scene, merging, context, stages));
  LogDecisions(start.motions, *scene, context);
  LOWLAP_RETURN_IF_ERROR(
      EstimateBelievedRatios(scene, start, merging, context, stages));
  {
    const StageLog::Scope scope(stages, "poses");
    // Inside pieces everything agrees, so that the residuals are no measure of
    // what is a little off across gaps: nothing of it is left out.
    LOWLAP_ASSIGN_OR_RETURN(
        result.poses,
        SolveScenePoses(scene, start.rotations, options.poses, context));
    LOWLAP_RETURN_IF_ERROR(CheckTies(*scene, result.poses, models, pieces,
                                     options.poses, context));
  }
  RestorePoses(measured, checks, pieces, scene);
  result.motions = std::move(start.motions);
  LOWLAP_RETURN_IF_ERROR(
      FinishSolution(scene, options, context, stages, &result));
  RestoreRatios(checks, pieces, scene);
  result.ratios = SummarizeRatios(scene->scale_ratios);
  return result;
}

}  // namespace lowlap
