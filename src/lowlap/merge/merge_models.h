#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// Cameras that a program has placed: views of a measured scene, in a frame and
/// a unit of their own.
struct PartialModel {
  std::string name;  // for people
  std::map<ViewId, Pose> poses;
};

/// The cameras of a solved scene as views of a measured one, matched by image
/// name as GroundTruthByName does; a warning counts those that are none.
/// Errors, with `name` as their file: kInsufficientData (no camera, or none
/// that the measured scene has), kInvalidScene (a name that fits two views, or
/// that two cameras have).
Result<PartialModel> MatchModel(const Scene& measured, const Scene& model,
                                std::string name, const RunContext& context);

/// A measured relative pose against a model's cameras.
struct PairAgreement {
  ViewPair views;
  /// Of the motions that the pair allows, the one that fits best; 0: its own.
  std::size_t hypothesis = 0;
  double rotation_error_rad = 0;
  double direction_error_rad = 0;
  /// Beyond one of these the two contradict each other.
  double rotation_limit_rad = 0;
  double direction_limit_rad = 0;

  bool Agrees() const {
    return rotation_error_rad <= rotation_limit_rad &&
           direction_error_rad <= direction_limit_rad;
  }
};

/// A measured, meaningful scale ratio against a model's cameras.
struct RatioAgreement {
  ViewTriplet views;
  double error = 0;  // of the model's log ratio: the model's minus measured
  double limit = 0;
  double log10_nfa = 0;

  bool Agrees() const { return error <= limit && error >= -limit; }
};

/// Cameras of a model whose places among one another are what was measured too.
struct RigidPiece {
  std::vector<ViewId> views;    // sorted
  std::vector<ViewPair> pairs;  // the relative poses that bear it out, sorted

  /// Whether the relative pose of two views is among `pairs`.
  bool Holds(ViewId a, ViewId b) const;
};

/// What measurements say about a model.
struct ModelCheck {
  std::vector<PairAgreement> pairs;    // of all relative poses inside, by views
  std::vector<RatioAgreement> ratios;  // of the triplets of those that agree
  /// Most views first, of three views at least; they may share views.
  std::vector<RigidPiece> pieces;
  /// The cameras that are in no piece, sorted.
  std::vector<ViewId> unconfirmed;
  /// The ratios as they were estimated.
  std::vector<ScaleRatio> measured_ratios;

  /// All of the model's cameras are in one piece.
  bool IsWhole() const { return pieces.size() == 1 && unconfirmed.empty(); }
};

/// Checks a model against the relative poses of `measured` between its views,
/// and against the scale ratios of their triplets.
///
/// A relative pose agrees within `outlier_reach` deviations of rotation and
/// direction, and within the angles below which none is called false
/// (PoseOptions); the deviation is the stated one, or that of all residuals if
/// this is larger. A ratio agrees likewise, and within a tenth.
///
/// Two baselines at a camera belong together if everything that agrees, each
/// with the deviation that would have been let pass, fixes the ratio of their
/// lengths to a tenth; they do not if a measured ratio contradicts. Pieces are
/// what most of this evidence holds together (ClusterByLinks). Between them the
/// model holds a scale or a turn that measurements contradict, or say nothing
/// about. So a model in which two parts were put together at one camera with a
/// wrong scale falls into the two parts, though all its directions are right.
///
/// Errors: those of the options, of EstimateScaleRatios, and kCancelled.
Result<ModelCheck> CheckModel(const Scene& measured, const PartialModel& model,
                              const SolveOptions& options,
                              const RunContext& context);

/// CheckModel of each, with a stage of its own.
Result<std::vector<ModelCheck>> CheckModels(
    const Scene& measured, const std::vector<PartialModel>& models,
    const SolveOptions& options, const RunContext& context, StageLog* stages);

/// What a check found, a line for each thing that a person should know: how
/// much is borne out, the pieces, what contradicts between them, and the
/// cameras that nothing bears out.
std::vector<std::string> DescribeCheck(const PartialModel& model,
                                       const ModelCheck& check,
                                       const Scene& measured);

/// One model of everything: `checks` are the CheckModels of `models`.
///
/// Inside a piece the model's relative poses, with the deviation that the
/// residuals leave it, and ratios replace the measured ones. All else is as in
/// SolveScene: relative poses and scale ratios across gaps, and of views that
/// nobody placed, are those that were measured, rotations, centres and
/// structure are solved for together, and adjusted.
///
/// The pieces must hang together by more than chance: by relative poses and
/// meaningful ratios that agree with the merged cameras and fix the scale, as a
/// model must to be one piece. Otherwise kInsufficientData says which pieces do
/// not, and what was measured between. Other errors: a model without any piece
/// (kInsufficientData), those of SolveScene. Like SolveScene it leaves the
/// scene in an intermediate state on error; afterwards the scene's relative
/// poses and ratios are those that were measured.
Result<SolveResult> MergeModels(Scene* scene,
                                const std::vector<PartialModel>& models,
                                const std::vector<ModelCheck>& checks,
                                const SolveOptions& options,
                                const RunContext& context, StageLog* stages);

}  // namespace lowlap
