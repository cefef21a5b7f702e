#pragma once

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/averaging/rotations/scene_rotations.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scale/scale_estimator.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

struct SolveOptions {
  /// Never null; MakeScaleEstimator makes the built-in ones.
  std::shared_ptr<const ScaleEstimator> scale_estimator =
      MakeScaleEstimator(ScaleOptions());
  PoseOptions poses;
  StructureOptions structure;
  AdjustmentOptions adjustment;
  bool adjust = true;
  /// Ratios that the scene holds already are taken as they are, unless the
  /// choice of a motion changes one of their relative poses. For solving parts
  /// of one scene, with the same estimator.
  bool reuse_ratios = false;
  /// Whether relative poses of few matches may take another motion
  /// (ReconsiderPoses).
  bool reconsider_poses = true;

  Status Validate() const;
};

/// Counts of ratios by verdict.
struct RatioSummary {
  int num_triplets = 0;
  int num_meaningful = 0;
  int num_not_meaningful = 0;
  int num_without_candidates = 0;
  int num_rejected_negative = 0;
};

RatioSummary SummarizeRatios(const std::vector<ScaleRatio>& ratios);

/// Where structure is, in world, without what observes it.
struct StructurePositions {
  std::map<PointTrackId, Vec3> points;
  std::map<LineTrackId, std::array<Vec3, 2>> lines;  // ends
};

StructurePositions PositionsOf(const Scene& scene);

/// A relative pose that got another motion, which the rest of the scene and its
/// own matches bear out together.
struct ReconsideredPose {
  ViewPair views;
  double rotation_deg = 0;  // between the two
  /// By how much more speaks for the new one, in decimal digits.
  double gained_digits = 0;
};

struct SolveResult {
  /// One for every relative pose that came with alternatives, by views, without
  /// those that nothing decided and that were reconsidered.
  std::vector<HypothesisDecision> motions;
  std::vector<ReconsideredPose> reconsidered;  // by views
  RatioSummary ratios;
  PoseSummary poses;
  /// nullopt: none was built.
  std::optional<StructureSummary> structure;
  std::optional<AdjustmentSummary> adjustment;
  /// Poses before the adjustment, for comparison, and, if there was one, the
  /// structure.
  std::map<PoseId, Pose> poses_before_adjustment;
  StructurePositions structure_before_adjustment;
};

/// What every strategy of composing poses starts from.
struct SolveStart {
  std::vector<HypothesisDecision> motions;
  std::vector<ReconsideredPose> reconsidered;
  SceneRotations rotations;
  /// Relative poses that are no longer those whose ratios the scene may hold.
  std::set<ViewPair> replaced;
};

/// The first stage of SolveScene: holds the relative poses against their
/// matches (CheckDirections), settles their alternatives (DecideHypotheses),
/// looks at those of few matches again in the light of the others
/// (ReconsiderPoses), averages the rotations and chooses the relative poses to
/// believe.
Result<SolveStart> StartSolution(Scene* scene, const SolveOptions& options,
                                 const RunContext& context, StageLog* stages);

/// The second stage: replaces scene->scale_ratios by those of the triplets of
/// the relative poses that are believed.
Result<RatioSummary> EstimateBelievedRatios(Scene* scene,
                                            const SolveStart& start,
                                            const SolveOptions& options,
                                            const RunContext& context,
                                            StageLog* stages);

/// The third stage: scene->poses by the averager of the options
/// (SolveScenePoses), without the relative poses that are a little off if that
/// loses no view, and leaves no more parts whose scale directions alone do not
/// fix (AnalyzeRigidity): what closes a loop is kept.
Result<PoseSummary> ComposePoses(Scene* scene, const SceneRotations& rotations,
                                 const PoseOptions& options,
                                 const RunContext& context, StageLog* stages);

struct ComposedSolution {
  SolveStart start;
  RatioSummary ratios;
  PoseSummary poses;
};

/// These three, and what third views say of contests about the relative poses
/// in use (SettleContests).
Result<ComposedSolution> ComposeSolution(Scene* scene,
                                         const SolveOptions& options,
                                         const RunContext& context,
                                         StageLog* stages);

struct Refinement {
  StructureSummary structure;
  std::optional<AdjustmentSummary> adjustment;
  StructurePositions before_adjustment;
};

/// The last stages: structure from scene->poses and, if options.adjust, bundle
/// adjustment.
Result<Refinement> RefineSolution(Scene* scene, const SolveOptions& options,
                                  const RunContext& context, StageLog* stages);

/// RefineSolution as SolveScene does it: `result`, which holds what became of
/// the poses, is completed. Where there is nothing to adjust (a graph without
/// features, views without intrinsics), or the adjustment finds no solution,
/// the poses stay as they are, with a warning in the log. The doubts about
/// views (PoseSummary::reliability_warnings) become those in the light of the
/// adjustment (FindReliabilityWarnings), of the structure (FindLostFeatures,
/// FindMissingMatches, FindLookAlikes) and of the stated deviations
/// (FindImpreciseViews).
Status FinishSolution(Scene* scene, const SolveOptions& options,
                      const RunContext& context, StageLog* stages,
                      SolveResult* result);

/// From measurements to a calibrated scene: choice between alternative motions,
/// rotations and the choice of relative poses, ratios of the triplets of those
/// believed, absolute poses (ComposeSolution), the motions that only the whole
/// scene tells apart (DecideHypothesesByStructure), structure, bundle
/// adjustment (FinishSolution); once more without relative poses that join
/// places that look alike (FinishWithoutLookAlikes). Reads intrinsics,
/// features, relative poses and tracks; settles alternatives and replaces scale
/// ratios, poses and structure. Errors leave the scene in an intermediate
/// state: keep a copy if you need it.
Result<SolveResult> SolveScene(Scene* scene, const SolveOptions& options,
                               const RunContext& context, StageLog* stages);

}  // namespace lowlap
