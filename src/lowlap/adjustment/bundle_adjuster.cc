#include "lowlap/adjustment/bundle_adjuster.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>

#include "lowlap/adjustment/internal/rounds/calibration_score.h"
#include "lowlap/adjustment/internal/rounds/outlier_round.h"
#include "lowlap/adjustment/internal/rounds/pair_selection.h"
#include "lowlap/adjustment/internal/rounds/pair_terms.h"
#include "lowlap/adjustment/internal/rounds/solve.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/scene/validation.h"

namespace lowlap {
namespace {

constexpr char kFinalStage[] = "final";
constexpr double kRoughTolerance = 1e-5;
// Pairs could be exchanged for one another for ever.
constexpr int kRoundsWithNewPairs = 3;
constexpr double kFirstTolerance = 1e-3;

struct KindRmse {
  double points_px = 0;
  double lines_px = 0;
  double coplanar_px = 0;
};

class Mean {
 public:
  void Add(double squared) {
    sum_ += squared;
    ++count_;
  }
  double Root() const { return count_ > 0 ? std::sqrt(sum_ / count_) : 0; }

 private:
  double sum_ = 0;
  double count_ = 0;
};

// Of the candidates in use.
KindRmse ComputeRmse(const CameraSet& cameras, const StructureState& state,
                     AdjustedCoplanarResidual residual) {
  Mean points, lines, coplanar;
  for (const PointTrackState& track : state.points) {
    if (!track.IsLandmark()) continue;
    for (const PointCandidate& candidate : track.candidates) {
      if (!candidate.used) continue;
      const double error = PointErrorPx(cameras, candidate, track.position);
      if (std::isfinite(error)) points.Add(error * error);
    }
  }
  for (const LineTrackState& track : state.lines) {
    if (!track.IsLandmark()) continue;
    for (const LineCandidate& candidate : track.candidates) {
      if (!candidate.used) continue;
      const double error =
          LineErrorPx(cameras, candidate, track.point, track.direction);
      if (std::isfinite(error)) lines.Add(error * error);
    }
  }
  for (const PairState& pair : state.pairs) {
    if (!pair.used || !state.lines[pair.first].IsLandmark() ||
        !state.lines[pair.second].IsLandmark()) {
      continue;
    }
    const double error = PairErrorPx(cameras, state, pair, residual);
    if (std::isfinite(error)) coplanar.Add(error * error);
  }
  return {points.Root(), lines.Root(), coplanar.Root()};
}

template <class Track>
void CountObservations(const std::vector<Track>& tracks,
                       KindAdjustment* summary) {
  for (const Track& track : tracks) {
    const std::size_t used =
        track.IsLandmark() ? static_cast<std::size_t>(track.UsedCount()) : 0;
    if (track.IsLandmark()) ++summary->landmarks;
    summary->observations_used += used;
    summary->observations_dropped += track.candidates.size() - used;
  }
}

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

void WriteStructure(const CameraSet& cameras, const StructureState& state,
                    Scene* scene, AdjustmentSummary* summary) {
  std::map<PointTrackId, Landmark> structure;
  for (const PointTrackState& track : state.points) {
    const bool before = scene->structure.count(track.id) > 0;
    if (track.IsLandmark()) {
      structure.emplace(track.id, ToLandmark(cameras, track));
      summary->landmarks_added += before ? 0 : 1;
    } else {
      summary->landmarks_removed += before ? 1 : 0;
    }
  }
  std::map<LineTrackId, LineLandmark> line_structure;
  for (const LineTrackState& track : state.lines) {
    const bool before = scene->line_structure.count(track.id) > 0;
    if (track.IsLandmark()) {
      line_structure.emplace(track.id, ToLandmark(cameras, track));
      summary->landmarks_added += before ? 0 : 1;
    } else {
      summary->landmarks_removed += before ? 1 : 0;
    }
  }
  std::vector<CoplanarPair> pairs;
  for (const PairState& pair : state.pairs) {
    if (pair.consistent && state.lines[pair.first].IsLandmark() &&
        state.lines[pair.second].IsLandmark()) {
      pairs.push_back(
          {state.lines[pair.first].id, state.lines[pair.second].id});
    }
  }
  scene->structure = std::move(structure);
  scene->line_structure = std::move(line_structure);
  scene->coplanar_pairs = std::move(pairs);
}

void FillKinds(const NoiseLevels& noise, const KindRmse& initial,
               const KindRmse& final, const StructureState& state,
               std::size_t input_pairs, AdjustmentSummary* summary) {
  const auto fill = [](double initial_px, double final_px,
                       const NoiseScale& scale, KindAdjustment* kind) {
    kind->initial_rmse_px = initial_px;
    kind->final_rmse_px = final_px;
    kind->stddev_px = scale.stddev_px;
    kind->threshold_px = scale.threshold_px;
  };
  fill(initial.points_px, final.points_px, noise.points, &summary->points);
  fill(initial.lines_px, final.lines_px, noise.lines, &summary->lines);
  fill(initial.coplanar_px, final.coplanar_px, noise.coplanar,
       &summary->coplanar);
  CountObservations(state.points, &summary->points);
  CountObservations(state.lines, &summary->lines);
  std::set<int> linked;
  for (const PairState& pair : state.pairs) {
    if (!pair.used) {
      summary->coplanar.observations_surplus += pair.consistent ? 1 : 0;
      continue;
    }
    ++summary->coplanar.observations_used;
    linked.insert(pair.first);
    linked.insert(pair.second);
  }
  summary->coplanar.landmarks = linked.size();
  summary->coplanar.observations_dropped =
      input_pairs - summary->coplanar.observations_used -
      summary->coplanar.observations_surplus;
}

// The solves and rounds; what is left to do is to count and to write.
class Adjuster {
 public:
  Adjuster(const Scene& scene, const AdjustmentOptions& options,
           const RunContext& context, CameraSet* cameras, StructureState* state,
           AdjustmentSummary* summary)
      : scene_(scene),
        options_(options),
        context_(context),
        cameras_(cameras),
        state_(state),
        summary_(summary) {}

  Status Run() {
    // Before the observations are settled, a rough optimum will do.
    const double rough = std::max(options_.function_tolerance, kRoughTolerance);
    EstimateNoise();
    if (options_.use_lines && options_.use_coplanar) {
      SelectPairs(options_, *cameras_, noise_.coplanar.threshold_px, true,
                  state_);
    }
    initial_ = ComputeRmse(*cameras_, *state_, options_.coplanar_residual);
    if (options_.fixed_rotations_first) {
      LOWLAP_RETURN_IF_ERROR(
          Solve("fixed rotations", true, std::max(rough, kFirstTolerance)));
    }
    LOWLAP_RETURN_IF_ERROR(Solve("everything", false, rough));
    bool at_rest = options_.max_outlier_rounds == 0;
    for (int round = 1; round <= options_.max_outlier_rounds; ++round) {
      LOWLAP_ASSIGN_OR_RETURN(const double changed,
                              Update(round <= kRoundsWithNewPairs));
      at_rest = changed <= options_.outlier_round_tolerance;
      if (at_rest) break;
      summary_->outlier_rounds = round;
      LOWLAP_RETURN_IF_ERROR(
          Solve("round " + std::to_string(round), false, rough));
    }
    LOWLAP_RETURN_IF_ERROR(
        Solve(kFinalStage, false, options_.function_tolerance));
    LOWLAP_RETURN_IF_ERROR(
        FollowPoses(options_, noise_.lines, context_, *cameras_, state_));
    summary_->converged = at_rest && summary_->solves.back().converged;
    for (LineTrackState& line : state_->lines) {
      if (line.IsLandmark()) UpdateLineExtent(*cameras_, &line);
    }
    return {};
  }

  const NoiseLevels& noise() const { return noise_; }
  const KindRmse& initial() const { return initial_; }
  const SolveOutcome& last() const { return last_; }

 private:
  Status Solve(const std::string& stage, bool fixed_rotations,
               double function_tolerance) {
    const SolveRequest request{
        stage, fixed_rotations, function_tolerance, noise_,
        stage == kFinalStage && options_.compute_center_covariances};
    LOWLAP_ASSIGN_OR_RETURN(
        last_, SolveOnce(options_, request, context_, cameras_, state_));
    const SolveReport& report = last_.report;
    context_.Log(LogLevel::kInfo,
                 "adjustment: " + stage + ": cost " +
                     std::to_string(report.initial_cost) + " -> " +
                     std::to_string(report.final_cost) + " in " +
                     std::to_string(report.iterations) + " iterations");
    summary_->solves.push_back(report);
    summary_->iterations += report.iterations;
    return {};
  }

  // The shapes first: they say in which units the errors of points are.
  void EstimateNoise() {
    summary_->point_shape_exponent =
        EstimateShapeExponent(*cameras_, state_->points);
    WhitenPoints(summary_->point_shape_exponent, &state_->points);
    noise_ = EstimateAllNoise(*cameras_, *state_, options_);
  }

  // The share of the observations whose use changed.
  Result<double> Update(bool take_new_pairs) {
    // Segments are undistorted with the intrinsics of the last solve.
    if (options_.MovesIntrinsics()) RefreshRays(scene_, *cameras_, state_);
    LOWLAP_RETURN_IF_ERROR(
        FollowPoses(options_, noise_.lines, context_, *cameras_, state_));
    EstimateNoise();
    LOWLAP_ASSIGN_OR_RETURN(const ObservationChanges changes,
                            UpdateObservations(options_, noise_, take_new_pairs,
                                               context_, *cameras_, state_));
    return changes.total > 0 ? static_cast<double>(changes.changed) /
                                   static_cast<double>(changes.total)
                             : 0.0;
  }

  const Scene& scene_;
  const AdjustmentOptions& options_;
  const RunContext& context_;
  CameraSet* cameras_;
  StructureState* state_;
  AdjustmentSummary* summary_;
  NoiseLevels noise_;
  KindRmse initial_;
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

  AdjustmentSummary summary;
  CameraSet cameras(*scene);
  StructureState state;
  state.points = LoadPoints(*scene, cameras);
  state.lines = LoadLines(*scene, cameras, options.MovesIntrinsics());
  state.pairs = LoadPairs(*scene, state.lines);
  if (options.use_relative_poses) {
    state.priors = LoadRelativePosePriors(*scene, cameras);
  }
  summary.observations_without_camera =
      CountObservationsWithoutCamera(*scene, cameras);

  Adjuster adjuster(*scene, options, context, &cameras, &state, &summary);
  LOWLAP_RETURN_IF_ERROR(adjuster.Run());

  FillKinds(adjuster.noise(), adjuster.initial(),
            ComputeRmse(cameras, state, options.coplanar_residual), state,
            scene->coplanar_pairs.size(), &summary);
  summary.initial_cost = summary.solves.front().initial_cost;
  summary.final_cost = summary.solves.back().final_cost;
  summary.components = adjuster.last().components;
  summary.center_covariances = adjuster.last().center_covariances;
  std::set<PoseId> adjusted;
  for (std::size_t n = 0; n < cameras.poses.size(); ++n) {
    if (adjuster.last().pose_observed[n]) adjusted.insert(cameras.poses[n].id);
  }
  summary.poses_adjusted = adjusted.size();
  if (options.test_calibration) {
    if (!context.Progress("adjustment: calibration", 0, 1)) {
      return MakeError(ErrorCode::kCancelled, "stopped on request");
    }
    summary.calibration_preferences =
        FindCalibrationPreferences(options, adjuster.noise(), cameras, state);
  }
  for (const auto& [id, pose] : scene->poses) {
    if (adjusted.count(id) == 0) {
      summary.poses_without_observations.push_back(id);
    }
  }
  cameras.WriteTo(scene);
  WriteStructure(cameras, state, scene, &summary);
  summary.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count();
  return summary;
}

}  // namespace lowlap
