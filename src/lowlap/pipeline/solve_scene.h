#pragma once

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/adjustment/structure_builder.h"
#include "lowlap/averaging/motion_choice.h"
#include "lowlap/averaging/scene_poses.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scale/scale_options.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

struct SolveOptions {
  ScaleOptions scale;
  PoseOptions poses;
  StructureOptions structure;
  AdjustmentOptions adjustment;
  bool adjust = true;

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

struct SolveResult {
  /// One for every relative pose that came with alternatives, by views.
  std::vector<MotionDecision> motions;
  RatioSummary ratios;
  PoseSummary poses;
  StructureSummary structure;
  std::optional<AdjustmentSummary> adjustment;
  /// Poses before the adjustment, for comparison.
  std::map<PoseId, Pose> poses_before_adjustment;
};

/// From measurements to a calibrated scene: choice between alternative motions
/// (DecideMotions), rotations and the choice of relative poses, ratios of the
/// triplets of those believed, absolute poses, structure, bundle adjustment.
/// Reads intrinsics, features, relative poses and tracks; settles alternatives
/// and replaces scale ratios, poses and structure. Errors leave
/// the scene in an intermediate state: keep a copy if you need it.
Result<SolveResult> SolveScene(Scene* scene, const SolveOptions& options,
                               const RunContext& context, StageLog* stages);

}  // namespace lowlap
