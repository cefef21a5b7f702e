#include "lowlap/adjustment/internal/rounds/optimum_search.h"

#include <algorithm>
#include <string>
#include <utility>

#include "lowlap/adjustment/internal/costs/relative_pose_prior.h"
#include "lowlap/adjustment/internal/costs/scale_ratio_prior.h"
#include "lowlap/adjustment/internal/planes/free_landmark.h"
#include "lowlap/adjustment/internal/planes/scene_planes.h"
#include "lowlap/adjustment/internal/rounds/kind_statistics.h"
#include "lowlap/adjustment/internal/rounds/measurement_cost.h"
#include "lowlap/adjustment/internal/rounds/pairs.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

// Before the observations are settled, a rough optimum will do.
constexpr double kFirstTolerance = 1e-3;
constexpr double kRoughTolerance = 1e-5;
constexpr double kPlaneTolerance = 1e-4;
// Pairs could be exchanged for one another for ever.
constexpr int kRoundsWithNewPairs = 3;
constexpr int kRoundsWithPlanes = 3;
// The share of the observations that may still change when planes take over.
constexpr double kToleranceBeforePlanes = 1e-2;
// A wide gate is reached step by step: what is far off because the cameras are
// comes closer with what is let in first, and what is false does not.
constexpr double kGateStep = 3;  // thresholds
constexpr int kGateSteps = 3;

NoiseLevels Widened(NoiseLevels noise, double gate) {
  noise.points.threshold_px *= gate;
  noise.lines.threshold_px *= gate;
  return noise;
}

}  // namespace

Optimum LoadOptimum(const Scene& scene, const AdjustmentOptions& options) {
  Optimum optimum{CameraSet(scene), {}, {}, 0, {}, {}, false};
  StructureState& state = optimum.state;
  state.points = LoadPoints(scene, optimum.cameras);
  state.lines = LoadLines(scene, optimum.cameras, options.MovesIntrinsics());
  state.pairs = LoadPairs(scene, state.lines);
  if (options.use_relative_poses) {
    state.priors = LoadRelativePosePriors(scene, optimum.cameras);
  }
  if (options.use_scale_ratios) {
    state.ratio_priors = LoadScaleRatioPriors(scene, optimum.cameras);
  }
  return optimum;
}

Result<double> CostOf(const Optimum& optimum, const Optimum& scale,
                      const RunContext& context) {
  return MeasurementCost(optimum.cameras, optimum.state, scale.noise,
                         scale.point_shape_exponent, context);
}

OptimumSearch::OptimumSearch(const AdjustmentOptions& options,
                             const RunContext& context, const Scene& scene,
                             Optimum* optimum, AdjustmentSummary* summary,
                             const std::string& stage_prefix)
    : options_(options),
      context_(context),
      scene_(scene),
      now_(optimum),
      summary_(summary),
      stage_prefix_(stage_prefix) {}

Status OptimumSearch::Settle() {
  LOWLAP_RETURN_IF_ERROR(FirstSolves());
  return SettleObservations();
}

Status OptimumSearch::Prepare() {
  EstimateNoise();
  LOWLAP_RETURN_IF_ERROR(FindDirections());
  if (options_.use_lines && options_.use_coplanar) {
    SelectPairs(options_, now_->cameras, now_->noise.coplanar.threshold_px,
                true, &now_->state);
  }
  const KindRmse initial =
      ComputeRmse(now_->cameras, now_->state, options_.coplanar_residual);
  summary_->points.initial_rmse_px = initial[0];
  summary_->lines.initial_rmse_px = initial[1];
  summary_->coplanar.initial_rmse_px = initial[2];
  return {};
}

Status OptimumSearch::FirstSolves() {
  if (options_.fixed_rotations_first) {
    LOWLAP_RETURN_IF_ERROR(Solve("fixed rotations", true, kFirstTolerance));
  }
  // Without its plane a wall leaves a valley, along which the last digits of
  // the cost would lead far away.
  return Solve("everything", false, kFirstTolerance);
}

// Ends with planes, where there are any, or with observations at rest.
Status OptimumSearch::SettleObservations() {
  bool with_planes = options_.use_lines && options_.use_coplanar &&
                     options_.coplanar_ties != CoplanarTies::kPairs;
  now_->at_rest = options_.max_outlier_rounds == 0;
  for (int round = 1; round <= options_.max_outlier_rounds; ++round) {
    LOWLAP_ASSIGN_OR_RETURN(const ObservationChanges changes,
                            Update({round <= kRoundsWithNewPairs}));
    const double changed = changes.Share();
    if (with_planes && changed <= kToleranceBeforePlanes) {
      LOWLAP_RETURN_IF_ERROR(LinkPlanes());
      if (!now_->state.planes.empty()) return {};
      with_planes = false;
    }
    now_->at_rest = changed <= options_.outlier_round_tolerance;
    if (now_->at_rest) break;
    ++summary_->outlier_rounds;
    RegroupDirections();
    LOWLAP_RETURN_IF_ERROR(
        Solve("round " + std::to_string(round), false, kRoughTolerance));
  }
  if (with_planes) LOWLAP_RETURN_IF_ERROR(LinkPlanes());
  return {};
}

// Every round draws together what lies on a plane.
Status OptimumSearch::TiePlanes() {
  const int rounds = now_->state.planes.empty() ? 0 : kRoundsWithPlanes;
  if (rounds > 0 && options_.coplanar_ties == CoplanarTies::kPlanes) {
    for (PairState& pair : now_->state.pairs) pair.used = false;
  }
  for (int round = 1; round <= rounds; ++round) {
    if (round > 1) LOWLAP_RETURN_IF_ERROR(LinkPlanes());
    LOWLAP_RETURN_IF_ERROR(
        Solve("planes " + std::to_string(round), false, kPlaneTolerance));
    if (options_.max_outlier_rounds == 0) continue;
    LOWLAP_ASSIGN_OR_RETURN(const ObservationChanges changes, Update({}));
    // With the ties, one on the verge may change sides for ever.
    now_->at_rest = changes.changed <= 1 ||
                    changes.Share() <= options_.outlier_round_tolerance;
  }
  return {};
}

// False if nothing came in.
Result<bool> OptimumSearch::WidenGate() {
  now_->state.planes.clear();
  for (int step = 1; step <= kGateSteps; ++step) {
    const double gate = step * kGateStep;
    LOWLAP_ASSIGN_OR_RETURN(const ObservationChanges changes,
                            Update({false, gate}));
    if (step == 1 && changes.changed == 0) return false;
    RegroupDirections();
    const NoiseLevels noise = now_->noise;
    now_->noise = Widened(noise, gate);
    LOWLAP_RETURN_IF_ERROR(
        Solve("gate " + std::to_string(step), false, kRoughTolerance));
    now_->noise = noise;
  }
  return true;
}

Status OptimumSearch::Complete() {
  const Optimum settled = *now_;
  LOWLAP_RETURN_IF_ERROR(TiePlanes());
  if (options_.max_outlier_rounds == 0) return {};
  Optimum best = *now_;
  const std::string prefix = stage_prefix_;
  stage_prefix_ += "again: ";
  const Status status = SearchAgain(settled, &best);
  stage_prefix_ = prefix;
  *now_ = std::move(best);
  // A search that fails is none.
  if (!status && status.error().code == ErrorCode::kCancelled) return status;
  return {};
}

Status OptimumSearch::SearchAgain(const Optimum& settled, Optimum* best) {
  LOWLAP_ASSIGN_OR_RETURN(bool better, WidenGate());
  if (!better) return {};
  LOWLAP_RETURN_IF_ERROR(SettleObservations());
  // Planes cost most of the time: what is no better before them is left there.
  LOWLAP_ASSIGN_OR_RETURN(better, ExplainsMoreThan(settled));
  if (!better) return {};
  LOWLAP_RETURN_IF_ERROR(TiePlanes());
  LOWLAP_ASSIGN_OR_RETURN(better, ExplainsMoreThan(*best));
  if (better) *best = *now_;
  return {};
}

Status OptimumSearch::Run() {
  LOWLAP_RETURN_IF_ERROR(Prepare());
  LOWLAP_RETURN_IF_ERROR(Settle());
  return Complete();
}

Status OptimumSearch::CompleteFrom(const AdjustmentOptions& kind) {
  OptimumSearch alone(kind, context_, scene_, now_, summary_,
                      stage_prefix_ + "alone: ");
  LOWLAP_RETURN_IF_ERROR(alone.Run());
  now_->state.planes.clear();
  if (const auto changes = Update({true}); !changes) {
    return tl::unexpected<Error>(changes.error());
  }
  RegroupDirections();
  LOWLAP_RETURN_IF_ERROR(Solve("everything", false, kFirstTolerance));
  LOWLAP_RETURN_IF_ERROR(SettleObservations());
  return Complete();
}

Status OptimumSearch::Finish() { return Solve("final", false, 0); }

Result<bool> OptimumSearch::ExplainsMoreThan(const Optimum& other) const {
  LOWLAP_ASSIGN_OR_RETURN(const double here, CostOf(*now_, other, context_));
  LOWLAP_ASSIGN_OR_RETURN(const double there, CostOf(other, other, context_));
  return here < there;
}

Status OptimumSearch::Solve(const std::string& stage, bool fixed_rotations,
                            double least_tolerance) {
  const SolveRequest request{
      stage_prefix_ + stage, fixed_rotations,
      std::max(options_.function_tolerance, least_tolerance), now_->noise};
  LOWLAP_ASSIGN_OR_RETURN(now_->last, SolveOnce(options_, request, context_,
                                                &now_->cameras, &now_->state));
  // Segments are undistorted with the intrinsics of the last solve.
  if (options_.MovesIntrinsics()) {
    RefreshRays(scene_, now_->cameras, &now_->state);
  }
  const SolveReport& report = now_->last.report;
  context_.Log(LogLevel::kInfo, "adjustment: " + report.stage + ": cost " +
                                    std::to_string(report.initial_cost) +
                                    " -> " + std::to_string(report.final_cost) +
                                    " in " + std::to_string(report.iterations) +
                                    " iterations");
  summary_->solves.push_back(report);
  summary_->iterations += report.iterations;
  return {};
}

// The shapes first: they say in which units the errors of points are.
void OptimumSearch::EstimateNoise() {
  std::vector<PointTrackState>& points = now_->state.points;
  now_->point_shape_exponent = EstimateShapeExponent(now_->cameras, points);
  WhitenPoints(now_->point_shape_exponent, &points);
  now_->noise = EstimateAllNoise(now_->cameras, now_->state, options_);
}

// Seen through a calibration that moves they would be others. Those of the
// start stay: no relative pose had a part in them.
Status OptimumSearch::FindDirections() {
  if (!options_.use_directions || !options_.use_lines ||
      options_.coplanar_ties == CoplanarTies::kPairs ||
      options_.MovesIntrinsics()) {
    return {};
  }
  if (now_->direction_sights.empty()) {
    LOWLAP_ASSIGN_OR_RETURN(
        now_->direction_sights,
        FindDirectionSights(scene_, now_->cameras, context_));
  }
  RegroupDirections();
  return {};
}

void OptimumSearch::RegroupDirections() {
  now_->state.directions =
      GroupDirections(now_->direction_sights, now_->cameras);
}

// The planes of the structure as it is; those before, should there be none.
Status OptimumSearch::LinkPlanes() {
  LOWLAP_ASSIGN_OR_RETURN(std::vector<PlaneState> planes,
                          FindPlanes(FreeLandmarks(options_, now_->noise,
                                                   now_->cameras, now_->state),
                                     context_));
  if (!planes.empty()) now_->state.planes = std::move(planes);
  return {};
}

Result<ObservationChanges> OptimumSearch::Update(
    const ObservationUpdate& update) {
  LOWLAP_RETURN_IF_ERROR(FollowPoses(options_, now_->noise.lines, context_,
                                     now_->cameras, &now_->state));
  EstimateNoise();
  return UpdateObservations(options_, now_->noise, update, context_,
                            now_->cameras, &now_->state);
}

}  // namespace lowlap
