#include "lowlap/adjustment/bundle_adjuster.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "lowlap/adjustment/internal/planes/free_landmark.h"
#include "lowlap/adjustment/internal/planes/scene_planes.h"
#include "lowlap/adjustment/internal/rounds/calibration_score.h"
#include "lowlap/adjustment/internal/rounds/kind_statistics.h"
#include "lowlap/adjustment/internal/rounds/outlier_round.h"
#include "lowlap/adjustment/internal/rounds/pairs.h"
#include "lowlap/adjustment/internal/rounds/solve.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"
#include "lowlap/adjustment/internal/uncertainty/calibration_shift.h"
#include "lowlap/adjustment/internal/uncertainty/center_covariances.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/scene/validation.h"

namespace lowlap {
namespace {

constexpr char kFinalStage[] = "final";
constexpr double kRoughTolerance = 1e-5;
// Pairs could be exchanged for one another for ever.
constexpr int kRoundsWithNewPairs = 3;
constexpr int kRoundsWithPlanes = 3;
// The share of the observations that may still change when planes take over.
constexpr double kToleranceBeforePlanes = 1e-2;
constexpr double kPlaneTolerance = 1e-4;
constexpr double kFirstTolerance = 1e-3;

std::size_t CountObservationsWithoutCamera(const Scene& scene,
                                           const CameraSet& cameras) {
  std::size_t count = 0;
  const auto add = [&](const auto& observations) {
    for (const auto& observation : observations) {
      if (cameras.Find(observation.view) < 0) ++count;
    }
  };
  for (const auto& [id, landmark] : scene.structure) add(landmark.observations);
  for (const auto& [id, line] : scene.line_structure) add(line.observations);
  return count;
}

template <class Track, class Landmarks>
void WriteLandmarks(const CameraSet& cameras, const std::vector<Track>& tracks,
                    Landmarks* landmarks, AdjustmentSummary* summary) {
  Landmarks written;
  for (const Track& track : tracks) {
    const bool before = landmarks->count(track.id) > 0;
    if (track.IsLandmark()) {
      written.emplace(track.id, ToLandmark(cameras, track));
      summary->landmarks_added += before ? 0 : 1;
    } else {
      summary->landmarks_removed += before ? 1 : 0;
    }
  }
  *landmarks = std::move(written);
}

class Adjuster {
 public:
  Adjuster(const AdjustmentOptions& options, const RunContext& context,
           const Scene& scene)
      : options_(options), context_(context), scene_(scene), cameras_(scene) {
    state_.points = LoadPoints(scene, cameras_);
    state_.lines = LoadLines(scene, cameras_, options.MovesIntrinsics());
    state_.pairs = LoadPairs(scene, state_.lines);
    if (options.use_relative_poses) {
      state_.priors = LoadRelativePosePriors(scene, cameras_);
    }
    if (options.use_scale_ratios) {
      state_.ratio_priors = LoadScaleRatioPriors(scene, cameras_);
    }
    summary_.observations_without_camera =
        CountObservationsWithoutCamera(scene, cameras_);
  }

  // The solves and rounds.
  Status Run() {
    // Before the observations are settled, a rough optimum will do.
    const double rough = std::max(options_.function_tolerance, kRoughTolerance);
    EstimateNoise();
    LOWLAP_RETURN_IF_ERROR(FindDirections());
    if (options_.use_lines && options_.use_coplanar) {
      SelectPairs(options_, cameras_, noise_.coplanar.threshold_px, true,
                  &state_);
    }
    initial_ = ComputeRmse(cameras_, state_, options_.coplanar_residual);
    if (options_.fixed_rotations_first) {
      LOWLAP_RETURN_IF_ERROR(
          Solve("fixed rotations", true, std::max(rough, kFirstTolerance)));
    }
    // Without its plane a wall leaves a valley, along which the last digits of
    // the cost would lead far away.
    LOWLAP_RETURN_IF_ERROR(
        Solve("everything", false, std::max(rough, kFirstTolerance)));
    bool with_planes = options_.use_lines && options_.use_coplanar &&
                       options_.coplanar_ties != CoplanarTies::kPairs;
    bool at_rest = options_.max_outlier_rounds == 0;
    for (int round = 1; round <= options_.max_outlier_rounds; ++round) {
      LOWLAP_ASSIGN_OR_RETURN(const ObservationChanges changes,
                              Update(round <= kRoundsWithNewPairs));
      const double changed = changes.Share();
      if (with_planes && changed <= kToleranceBeforePlanes) {
        LOWLAP_RETURN_IF_ERROR(LinkPlanes());
        if (!state_.planes.empty()) break;
        with_planes = false;
      }
      at_rest = changed <= options_.outlier_round_tolerance;
      if (at_rest) break;
      summary_.outlier_rounds = round;
      state_.directions = GroupDirections(sights_, cameras_);
      LOWLAP_RETURN_IF_ERROR(
          Solve("round " + std::to_string(round), false, rough));
    }
    if (with_planes && state_.planes.empty()) {
      LOWLAP_RETURN_IF_ERROR(LinkPlanes());
    }
    if (!state_.planes.empty()) {
      LOWLAP_RETURN_IF_ERROR(SolveWithPlanes(&at_rest));
    }
    LOWLAP_RETURN_IF_ERROR(
        Solve(kFinalStage, false, options_.function_tolerance));
    LOWLAP_RETURN_IF_ERROR(
        FollowPoses(options_, noise_.lines, context_, cameras_, &state_));
    summary_.converged = at_rest && summary_.solves.back().converged;
    for (LineTrackState& line : state_.lines) {
      if (line.IsLandmark()) UpdateLineExtent(cameras_, &line);
    }
    return {};
  }

  // What came of them; the scene is not changed yet.
  Result<AdjustmentSummary> Summarise() {
    const KindRmse final =
        ComputeRmse(cameras_, state_, options_.coplanar_residual);
    const NoiseScale* const noises[] = {&noise_.points, &noise_.lines,
                                        &noise_.coplanar};
    KindAdjustment* const kinds[] = {&summary_.points, &summary_.lines,
                                     &summary_.coplanar};
    for (std::size_t k = 0; k < final.size(); ++k) {
      kinds[k]->initial_rmse_px = initial_[k];
      kinds[k]->final_rmse_px = final[k];
      kinds[k]->stddev_px = noises[k]->stddev_px;
      kinds[k]->threshold_px = noises[k]->threshold_px;
    }
    CountObservations(state_.points, &summary_.points);
    CountObservations(state_.lines, &summary_.lines);
    CountPairs(state_.pairs, scene_.coplanar_pairs.size(), &summary_.coplanar);
    summary_.initial_cost = summary_.solves.front().initial_cost;
    summary_.final_cost = summary_.solves.back().final_cost;
    summary_.directions = state_.directions.size();
    summary_.components = last_.components;
    std::set<PoseId> adjusted;
    for (std::size_t n = 0; n < cameras_.poses.size(); ++n) {
      if (last_.pose_observed[n]) adjusted.insert(cameras_.poses[n].id);
    }
    summary_.poses_adjusted = adjusted.size();
    for (const auto& [id, pose] : scene_.poses) {
      if (adjusted.count(id) == 0) {
        summary_.poses_without_observations.push_back(id);
      }
    }
    if (options_.test_calibration) {
      if (!context_.Progress("adjustment: calibration", 0, 1)) {
        return MakeError(ErrorCode::kCancelled, "stopped on request");
      }
      summary_.calibration_preferences =
          FindCalibrationPreferences(options_, noise_, cameras_, state_);
    }
    if (options_.estimate_uncertainty) {
      LOWLAP_RETURN_IF_ERROR(EstimateUncertainty());
    }
    return summary_;
  }

  void WriteTo(Scene* scene, AdjustmentSummary* summary) const {
    cameras_.WriteTo(scene);
    for (auto& [id, pose] : scene->poses) {
      const auto found = center_covariances_.find(id);
      pose.center_covariance.reset();
      if (found != center_covariances_.end()) {
        pose.center_covariance = found->second;
      }
    }
    WriteLandmarks(cameras_, state_.points, &scene->structure, summary);
    WriteLandmarks(cameras_, state_.lines, &scene->line_structure, summary);
    scene->coplanar_pairs.clear();
    for (const PairState& pair : state_.pairs) {
      if (pair.consistent && state_.HasLines(pair)) {
        scene->coplanar_pairs.push_back(
            {state_.lines[pair.first].id, state_.lines[pair.second].id});
      }
    }
  }

 private:
  Status EstimateUncertainty() {
    if (!context_.Progress("adjustment: uncertainty", 0, 1)) {
      return MakeError(ErrorCode::kCancelled, "stopped on request");
    }
    std::vector<ViewTriplet> triplets;
    for (const ScaleRatio& ratio : scene_.scale_ratios) {
      triplets.push_back(ratio.views);
    }
    std::vector<ViewPair> pairs;
    for (const auto& entry : scene_.relative_poses) {
      pairs.push_back(entry.first);
    }
    CenterUncertainty uncertainty = EstimateCenterUncertainty(
        options_, noise_, triplets, pairs, cameras_, state_);
    LOWLAP_RETURN_IF_ERROR(
        AddCalibrationShift(options_, noise_, summary_.calibration_preferences,
                            scene_, context_, cameras_, state_, &uncertainty));
    summary_.log_ratio_stddevs = std::move(uncertainty.log_ratio_stddevs);
    summary_.direction_stddevs_rad =
        std::move(uncertainty.direction_stddevs_rad);
    center_covariances_ = std::move(uncertainty.covariances);
    return {};
  }

  Status Solve(const std::string& stage, bool fixed_rotations,
               double function_tolerance) {
    const SolveRequest request{stage, fixed_rotations, function_tolerance,
                               noise_};
    LOWLAP_ASSIGN_OR_RETURN(
        last_, SolveOnce(options_, request, context_, &cameras_, &state_));
    // Segments are undistorted with the intrinsics of the last solve.
    if (options_.MovesIntrinsics()) RefreshRays(scene_, cameras_, &state_);
    const SolveReport& report = last_.report;
    context_.Log(LogLevel::kInfo,
                 "adjustment: " + stage + ": cost " +
                     std::to_string(report.initial_cost) + " -> " +
                     std::to_string(report.final_cost) + " in " +
                     std::to_string(report.iterations) + " iterations");
    summary_.solves.push_back(report);
    summary_.iterations += report.iterations;
    return {};
  }

  // The shapes first: they say in which units the errors of points are.
  void EstimateNoise() {
    summary_.point_shape_exponent =
        EstimateShapeExponent(cameras_, state_.points);
    WhitenPoints(summary_.point_shape_exponent, &state_.points);
    noise_ = EstimateAllNoise(cameras_, state_, options_);
  }

  // Seen through a calibration that moves they would be others.
  Status FindDirections() {
    if (!options_.use_directions || !options_.use_lines ||
        options_.coplanar_ties == CoplanarTies::kPairs ||
        options_.MovesIntrinsics()) {
      return {};
    }
    LOWLAP_ASSIGN_OR_RETURN(sights_,
                            FindDirectionSights(scene_, cameras_, context_));
    state_.directions = GroupDirections(sights_, cameras_);
    return {};
  }

  // The planes of the structure as it is; those before, should there be none.
  Status LinkPlanes() {
    LOWLAP_ASSIGN_OR_RETURN(
        std::vector<PlaneState> planes,
        FindPlanes(FreeLandmarks(options_, noise_, cameras_, state_),
                   context_));
    if (!planes.empty()) state_.planes = std::move(planes);
    return {};
  }

  // Every round draws together what lies on a plane.
  Status SolveWithPlanes(bool* at_rest) {
    if (options_.coplanar_ties == CoplanarTies::kPlanes) {
      for (PairState& pair : state_.pairs) pair.used = false;
    }
    for (int round = 1; round <= kRoundsWithPlanes; ++round) {
      if (round > 1) LOWLAP_RETURN_IF_ERROR(LinkPlanes());
      LOWLAP_RETURN_IF_ERROR(
          Solve("planes " + std::to_string(round), false, kPlaneTolerance));
      if (options_.max_outlier_rounds == 0) continue;
      LOWLAP_ASSIGN_OR_RETURN(const ObservationChanges changes, Update(false));
      // With the ties, one on the verge may change sides for ever.
      *at_rest = changes.changed <= 1 ||
                 changes.Share() <= options_.outlier_round_tolerance;
    }
    summary_.planes = state_.planes.size();
    for (const PlaneState& plane : state_.planes) {
      summary_.landmarks_on_planes += plane.points.size() + plane.lines.size();
    }
    return {};
  }

  Result<ObservationChanges> Update(bool take_new_pairs) {
    LOWLAP_RETURN_IF_ERROR(
        FollowPoses(options_, noise_.lines, context_, cameras_, &state_));
    EstimateNoise();
    return UpdateObservations(options_, noise_, take_new_pairs, context_,
                              cameras_, &state_);
  }

  const AdjustmentOptions& options_;
  const RunContext& context_;
  const Scene& scene_;
  CameraSet cameras_;
  StructureState state_;
  std::vector<DirectionSight> sights_;
  AdjustmentSummary summary_;
  NoiseLevels noise_;
  std::map<PoseId, Mat3> center_covariances_;
  KindRmse initial_{};
  SolveOutcome last_;
};

}  // namespace

Result<AdjustmentSummary> AdjustScene(Scene* scene,
                                      const AdjustmentOptions& options,
                                      const RunContext& context) {
  const auto start = std::chrono::steady_clock::now();
  if (scene == nullptr) {
    return MakeError(ErrorCode::kInvalidArgument, "the scene is null");
  }
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  LOWLAP_RETURN_IF_ERROR(ValidateScene(*scene));
  for (const auto& [id, refinement] : options.refine_intrinsics) {
    if (scene->intrinsics.count(id) == 0) {
      return MakeError(
          ErrorCode::kInvalidArgument,
          "there is no intrinsic " + std::to_string(id.value()) + " to refine");
    }
  }

  Adjuster adjuster(options, context, *scene);
  LOWLAP_RETURN_IF_ERROR(adjuster.Run());
  LOWLAP_ASSIGN_OR_RETURN(AdjustmentSummary summary, adjuster.Summarise());
  adjuster.WriteTo(scene, &summary);
  summary.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count();
  return summary;
}

}  // namespace lowlap
