#pragma once

#include <memory>
#include <vector>

#include "lowlap/averaging/reliability_warning.h"
#include "lowlap/averaging/rotations/scene_rotations.h"
#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

struct PoseOptions {
  /// The translation strategy; null: lowlap's own, `graph`.
  std::shared_ptr<const TranslationAverager> averager;
  RotationAveragingOptions rotation;
  /// A relative pose whose rotation (direction) disagrees with the averaged
  /// rotations (the solved centres) by more than this many robust standard
  /// deviations of all residuals is left out.
  double outlier_reach = 5.0;
  /// Nor is a relative pose left out that is closer than this (its direction:
  /// three times this), however small its stated deviation, which covers
  /// neither calibration nor what errors have in common. Robust weights deal
  /// with it.
  double least_false_deg = kLittleDeg;

  Status Validate() const;
};

/// Views that only `links`, in use, join to the others, and what contradicts
/// these and may be right together: more than half as much evidence, as it
/// counts (ThirdViewVerdicts::evidence), as they have, or as the best ratio
/// across the one camera that they share. The scene solved without the links
/// does not tell which are right.
struct Contest {
  std::vector<ViewPair> links;
  std::vector<ViewPair> contradictions;
  std::vector<ViewId> views;
  /// Where the contradictions contradict several cuts, the links of the one of
  /// least evidence; none if only the scale is contested.
  std::vector<ViewPair> weakest_links = {};
  /// The least evidence that is contradicted, and that of each contradiction.
  double evidence = 0;
  std::vector<double> evidence_against = {};
};

/// The relative poses and ratios in use that agree with the solution and can be
/// relied on alone.
struct FirmEvidence {
  std::vector<ViewPair> edges;
  std::vector<ViewTriplet> ratios;
};

/// What of the measurements agrees with the centres before any adjustment.
struct SolutionAgreement;

/// What the structure says of relative poses that join places that look alike.
struct LookAlikes;

/// What became of the views and edges on the way to absolute poses.
struct PoseSummary {
  int num_views = 0;
  int num_placed = 0;
  /// Views by component; component 0 is the one whose poses the scene gets.
  std::vector<std::vector<ViewId>> components;
  std::vector<ViewId> unplaced;
  std::vector<OutlierEdge> outlier_edges;  // by views
  /// In use though their directions contradict the solved centres: without them
  /// views would be lost. By views.
  std::vector<OutlierEdge> kept_outliers;
  /// The ratio, if any, that was left out since only without it the directions
  /// agree with one another.
  std::vector<ViewTriplet> left_out_ratios;
  MatchVerdicts matches;
  // As in SceneRotations; the last two among the placed views only.
  std::vector<LoopClosing> loops;
  std::vector<ContestedLink> contested;
  std::vector<ViewPair> unchecked;
  std::vector<Contest> contests;  // of placed views
  std::shared_ptr<const SolutionAgreement> agreement;
  FirmEvidence firm_evidence;
  /// Before FinishSolution those of an earlier solution, which is left for
  /// their sake, or nullptr; empty without structure.
  std::shared_ptr<const LookAlikes> look_alikes;
  /// Triplets whose ratio chance explains as well, used since nothing else
  /// joins one of their views.
  std::vector<ViewTriplet> weak_ratios;
  /// Views whose place the evidence does not bear out: FindReliabilityWarnings.
  std::vector<ReliabilityWarning> reliability_warnings;
  int num_edges = 0;
  int num_ratios = 0;
  double median_rotation_residual_deg = 0;

  /// Something contradicts what is placed, and nothing decides between them (a
  /// loop that does not close, a contest), a weak ratio places it, or
  /// views are doubtful for a reason of their own.
  bool IsDoubtful() const {
    return !loops.empty() || !contested.empty() || !contests.empty() ||
           !weak_ratios.empty() || !reliability_warnings.empty();
  }
  /// All views are placed, and nothing is doubtful.
  bool IsFirm() const { return num_placed == num_views && !IsDoubtful(); }
};

/// Replaces scene->poses by those of component 0 of a solution. Gauge: the
/// first placed view has rotation identity and centre 0, and the mean length of
/// the placed edges is 1.
void SetPoses(const TranslationProblem& problem,
              const TranslationSolution& solution, Scene* scene);

/// scene.poses from scene.relative_poses and scene.scale_ratios, with the
/// rotations and the choice of relative poses of AverageSceneRotations, and the
/// chosen translation strategy. Relative poses whose direction contradicts the
/// solved centres are left out in turn, unless that loses a view, and the
/// solution is repeated. Where it loses one, a ratio of little evidence is left
/// out instead, if without it nothing contradicts
/// (SolveWithoutContradictedRatio; `left_out_ratios`); else the relative poses
/// stay (`kept_outliers`). Where those left out or kept have more evidence than
/// what they contradict, the scene is solved without that instead. Views that
/// no meaningful ratio joins are placed by ratios that are not, if at least two
/// points or lines, or three coplanar pairs, agree on them, and failing that by
/// those on which any two candidates agree; these are listed (`weak_ratios`).
/// The poses of the largest component replace scene.poses; the others have no
/// common scale with it and are listed. Gauge: that of SetPoses. Errors, with
/// the scene unchanged: invalid options, those of the strategy.
Result<PoseSummary> SolveScenePoses(Scene* scene,
                                    const SceneRotations& rotations,
                                    const PoseOptions& options,
                                    const RunContext& context);

/// The same, with AverageSceneRotations before it.
Result<PoseSummary> SolveScenePoses(Scene* scene, const PoseOptions& options,
                                    const RunContext& context);

/// AverageSceneRotations as these options ask for it; the random starts are
/// those of context.seed.
Result<SceneRotations> AverageSceneRotations(
    const Scene& scene, const PoseOptions& options, const RunContext& context,
    ThirdViewVerdicts third_views = {});

}  // namespace lowlap
