#include "lowlap/pipeline/solve_scene.h"

#include <algorithm>
#include <map>
#include <optional>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/averaging/centers/internal/evidence_against.h"
#include "lowlap/averaging/rigidity/internal/rigidity.h"
#include "lowlap/core/internal/joined.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/believed_evidence.h"
#include "lowlap/pipeline/internal/decisions/check_directions.h"
#include "lowlap/pipeline/internal/decisions/decide_hypotheses.h"
#include "lowlap/pipeline/internal/decisions/finish_without_look_alikes.h"
#include "lowlap/pipeline/internal/decisions/reconsider_poses.h"
#include "lowlap/pipeline/internal/decisions/settle_contests.h"
#include "lowlap/pipeline/internal/judge_views.h"
#include "lowlap/scale/scale_ratios.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {

Status SolveOptions::Validate() const {
  if (scale_estimator == nullptr) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "there is no scale estimator");
  }
  for (const Status& valid :
       {poses.Validate(), structure.Validate(), adjustment.Validate()}) {
    if (!valid) return valid;
  }
  return {};
}

RatioSummary SummarizeRatios(const std::vector<ScaleRatio>& ratios) {
  RatioSummary summary;
  for (const ScaleRatio& ratio : ratios) {
    ++summary.num_triplets;
    switch (ratio.verdict) {
      case RatioVerdict::kMeaningful:
        ++summary.num_meaningful;
        break;
      case RatioVerdict::kNotMeaningful:
        ++summary.num_not_meaningful;
        break;
      case RatioVerdict::kNoCandidates:
        ++summary.num_without_candidates;
        break;
    }
    summary.num_rejected_negative += ratio.num_rejected_negative;
  }
  return summary;
}

namespace {

// Nothing else would say why these take no part: a scene without intrinsics is
// a good one for poses that do not need them.
void WarnOfMissingIntrinsics(const Scene& scene, const RunContext& context) {
  std::vector<ViewId> missing;
  for (const auto& [id, view] : scene.views) {
    if (scene.FindIntrinsic(id) == nullptr) missing.push_back(id);
  }
  if (missing.empty()) return;
  context.Log(LogLevel::kWarning,
              std::to_string(missing.size()) + " of " +
                  std::to_string(scene.views.size()) +
                  " views have no intrinsic, so that nothing that they see "
                  "counts: " +
                  Joined(missing, ", ",
                         [&](ViewId view) { return scene.NameOf(view); }));
}

// The triplets of the relative poses that are believed: the others have no
// part in the solution, so their ratios would be computed for nothing.
std::vector<ViewTriplet> BelievedTriplets(const Scene& scene,
                                          const SceneRotations& rotations) {
  return FindTriplets(
      ViewGraph(scene).WithoutPairs(PairsOf(rotations.outliers)));
}

// The relative poses that are no longer what the scene came with.
std::set<ViewPair> ReplacedPoses(const SolveStart& start) {
  std::set<ViewPair> replaced;
  for (const HypothesisDecision& motion : start.motions) {
    if (motion.replaced) replaced.insert(motion.views);
  }
  for (const ReconsideredPose& pose : start.reconsidered) {
    replaced.insert(pose.views);
  }
  for (const ReplacedDirection& pose : start.rotations.matches.replaced) {
    replaced.insert(pose.views);
  }
  return replaced;
}

// Those that nothing decided, and that are no longer open.
void RemoveReconsidered(const std::vector<ReconsideredPose>& reconsidered,
                        std::vector<HypothesisDecision>* motions) {
  std::set<ViewPair> settled;
  for (const ReconsideredPose& pose : reconsidered) settled.insert(pose.views);
  motions->erase(std::remove_if(motions->begin(), motions->end(),
                                [&](const HypothesisDecision& motion) {
                                  return motion.grounds ==
                                             HypothesisGrounds::kNone &&
                                         settled.count(motion.views) > 0;
                                }),
                 motions->end());
}

// The ratios of the triplets, in their order; those in `known` are not
// estimated again, unless one of their relative poses is among the replaced.
Result<std::vector<ScaleRatio>> CompleteRatios(
    const Scene& scene, const std::vector<ViewTriplet>& triplets,
    std::vector<ScaleRatio> known, const std::set<ViewPair>& replaced,
    const ScaleEstimator& estimator, const RunContext& context) {
  const auto is_replaced = [&](ViewId a, ViewId b) {
    return replaced.count({std::min(a, b), std::max(a, b)}) > 0;
  };
  std::map<ViewTriplet, ScaleRatio> ratios;
  for (ScaleRatio& ratio : known) {
    const ViewTriplet views = ratio.views;
    if (!is_replaced(views.first, views.middle) &&
        !is_replaced(views.middle, views.last)) {
      ratios[views] = std::move(ratio);
    }
  }
  std::vector<ViewTriplet> missing;
  for (const ViewTriplet& views : triplets) {
    if (ratios.count(views) == 0) missing.push_back(views);
  }
  LOWLAP_ASSIGN_OR_RETURN(
      auto estimated, EstimateScaleRatios(scene, missing, estimator, context));
  for (ScaleRatio& ratio : estimated) ratios[ratio.views] = std::move(ratio);
  std::vector<ScaleRatio> complete;
  complete.reserve(triplets.size());
  for (const ViewTriplet& views : triplets) {
    complete.push_back(std::move(ratios.at(views)));
  }
  return complete;
}

// The number of parts of the placed views that directions alone leave with
// scales of their own.
std::size_t CountScaleParts(const Scene& scene, const PoseSummary& summary) {
  return AnalyzeRigidity(ViewGraph(scene)
                             .WithoutPairs(PairsOf(summary.outlier_edges))
                             .WithoutViews(summary.unplaced))
      .groups.size();
}

}  // namespace

StructurePositions PositionsOf(const Scene& scene) {
  StructurePositions positions;
  for (const auto& [id, landmark] : scene.structure) {
    positions.points.emplace_hint(positions.points.end(), id,
                                  landmark.position);
  }
  for (const auto& [id, line] : scene.line_structure) {
    positions.lines.emplace_hint(positions.lines.end(), id,
                                 std::array{line.start, line.end});
  }
  return positions;
}

Result<SolveStart> StartSolution(Scene* scene, const SolveOptions& options,
                                 const RunContext& context, StageLog* stages) {
  const StageLog::Scope scope(stages, "rotations");
  WarnOfMissingIntrinsics(*scene, context);
  SolveStart start;
  LOWLAP_ASSIGN_OR_RETURN(auto matches,
                          CheckDirections(scene, options.poses, context));
  LOWLAP_ASSIGN_OR_RETURN(start.motions,
                          DecideHypotheses(scene, *options.scale_estimator,
                                           options.poses, context));
  if (options.reconsider_poses) {
    LOWLAP_ASSIGN_OR_RETURN(start.reconsidered,
                            ReconsiderPoses(scene, options.poses, context));
    RemoveReconsidered(start.reconsidered, &start.motions);
  }
  LOWLAP_ASSIGN_OR_RETURN(
      start.rotations, AverageSceneRotations(*scene, options.poses, context));
  AddMatchVerdicts(std::move(matches), &start.rotations);
  start.replaced = ReplacedPoses(start);
  return start;
}

Result<RatioSummary> EstimateBelievedRatios(Scene* scene,
                                            const SolveStart& start,
                                            const SolveOptions& options,
                                            const RunContext& context,
                                            StageLog* stages) {
  const StageLog::Scope scope(stages, "scale ratios");
  std::vector<ScaleRatio> known;
  if (options.reuse_ratios) known = std::move(scene->scale_ratios);
  LOWLAP_ASSIGN_OR_RETURN(
      scene->scale_ratios,
      CompleteRatios(*scene, BelievedTriplets(*scene, start.rotations),
                     std::move(known), start.replaced, *options.scale_estimator,
                     context));
  return SummarizeRatios(scene->scale_ratios);
}

// Relative poses that are a little off bend what many others hold already, but
// may be all that holds a view, or all that closes a loop: they are left out if
// that loses no view, leaves no part of the views to its ratios alone, and has
// no more evidence against it.
Result<PoseSummary> ComposePoses(Scene* scene, const SceneRotations& rotations,
                                 const PoseOptions& options,
                                 const RunContext& context, StageLog* stages) {
  const StageLog::Scope scope(stages, "poses");
  auto all = SolveScenePoses(scene, rotations, options, context);
  if (!all || options.least_false_deg == 0) return all;
  PoseOptions strict = options;
  strict.least_false_deg = 0;
  auto fewer =
      AverageSceneRotations(*scene, strict, context, rotations.third_views);
  if (!fewer) {
    if (fewer.error().code == ErrorCode::kCancelled) {
      return tl::unexpected<Error>(fewer.error());
    }
    return all;
  }
  AddMatchVerdicts(rotations.matches, &*fewer);
  const std::map<PoseId, Pose> poses = scene->poses;
  const double against_all = EvidenceAgainstPoses(*scene, options);
  auto solved = SolveScenePoses(scene, *fewer, strict, context);
  if (!solved && solved.error().code == ErrorCode::kCancelled) return solved;
  if (solved && solved->num_placed >= all->num_placed &&
      solved->IsDoubtful() <= all->IsDoubtful() &&
      EvidenceAgainstPoses(*scene, options) <= against_all &&
      CountScaleParts(*scene, *solved) <= CountScaleParts(*scene, *all)) {
    return solved;
  }
  scene->poses = poses;
  return all;
}

Result<ComposedSolution> ComposeSolution(Scene* scene,
                                         const SolveOptions& options,
                                         const RunContext& context,
                                         StageLog* stages) {
  ComposedSolution composed;
  LOWLAP_ASSIGN_OR_RETURN(composed.start,
                          StartSolution(scene, options, context, stages));
  const SceneRotations& rotations = composed.start.rotations;
  LOWLAP_ASSIGN_OR_RETURN(
      composed.ratios,
      EstimateBelievedRatios(scene, composed.start, options, context, stages));
  LOWLAP_ASSIGN_OR_RETURN(
      composed.poses,
      ComposePoses(scene, rotations, options.poses, context, stages));
  LOWLAP_RETURN_IF_ERROR(
      SettleContests(options, context, stages, scene, &composed));
  return composed;
}

Result<Refinement> RefineSolution(Scene* scene, const SolveOptions& options,
                                  const RunContext& context, StageLog* stages) {
  Refinement refinement;
  {
    const StageLog::Scope scope(stages, "structure");
    LOWLAP_ASSIGN_OR_RETURN(refinement.structure,
                            BuildStructure(scene, options.structure, context));
  }
  if (options.adjust) {
    const StageLog::Scope scope(stages, "adjustment");
    refinement.before_adjustment = PositionsOf(*scene);
    LOWLAP_ASSIGN_OR_RETURN(refinement.adjustment,
                            AdjustScene(scene, options.adjustment, context));
  }
  return refinement;
}

Status FinishSolution(Scene* scene, const SolveOptions& options,
                      const RunContext& context, StageLog* stages,
                      SolveResult* result) {
  result->poses_before_adjustment = scene->poses;
  std::optional<BelievedEvidence> believed;
  believed.emplace(FalsePairs(result->poses), scene);
  auto refinement = RefineSolution(scene, options, context, stages);
  if (!refinement && options.adjust &&
      (refinement.error().code == ErrorCode::kInsufficientData ||
       refinement.error().code == ErrorCode::kNumerical)) {
    // The poses of a graph without features are a result too, and so are those
    // that are too poor to start from.
    context.Log(LogLevel::kWarning,
                "not adjusted: " + refinement.error().message);
    SolveOptions structure_only = options;
    structure_only.adjust = false;
    refinement = RefineSolution(scene, structure_only, context, stages);
  }
  believed.reset();
  if (!refinement) return tl::unexpected<Error>(refinement.error());
  result->structure = std::move(refinement->structure);
  result->adjustment = std::move(refinement->adjustment);
  result->structure_before_adjustment =
      std::move(refinement->before_adjustment);
  return JudgeViews(scene, result->adjustment, *options.scale_estimator,
                    context, &result->poses);
}

Result<SolveResult> SolveScene(Scene* scene, const SolveOptions& options,
                               const RunContext& context, StageLog* stages) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  LOWLAP_ASSIGN_OR_RETURN(auto composed,
                          ComposeSolution(scene, options, context, stages));
  return FinishWithoutLookAlikes(std::move(composed), options, context, stages,
                                 scene);
}

}  // namespace lowlap
