#include "lowlap/adjustment/bundle_adjuster.h"

#include <algorithm>
#include <chrono>
#include <map>
#include <set>
#include <string>
#include <utility>

#include "lowlap/adjustment/internal/calibration/calibration_preference.h"
#include "lowlap/adjustment/internal/rounds/kind_statistics.h"
#include "lowlap/adjustment/internal/rounds/optimum_starts.h"
#include "lowlap/adjustment/internal/rounds/outlier_round.h"
#include "lowlap/adjustment/internal/uncertainty/calibration_shift.h"
#include "lowlap/adjustment/internal/uncertainty/center_covariances.h"
#include "lowlap/adjustment/internal/uncertainty/jackknife.h"
#include "lowlap/adjustment/internal/uncertainty/rival_optima.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/scene/validation.h"

namespace lowlap {
namespace {

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
      : options_(options),
        context_(context),
        scene_(scene),
        optimum_(LoadOptimum(scene, options)) {
    summary_.observations_without_camera =
        CountObservationsWithoutCamera(scene, optimum_.cameras);
  }

  // The solves and rounds.
  Status Run() {
    LOWLAP_ASSIGN_OR_RETURN(
        rivals_, FindOptimum(options_, context_, scene_, &optimum_, &summary_));
    LOWLAP_RETURN_IF_ERROR(FollowPoses(options_, optimum_.noise.lines, context_,
                                       optimum_.cameras, &optimum_.state));
    for (LineTrackState& line : optimum_.state.lines) {
      if (line.IsLandmark()) UpdateLineExtent(optimum_.cameras, &line);
    }
    return {};
  }

  // What came of them; the scene is not changed yet.
  Result<AdjustmentSummary> Summarise() {
    const KindRmse final = ComputeRmse(optimum_.cameras, optimum_.state,
                                       options_.coplanar_residual);
    const NoiseScale* const noises[] = {&optimum_.noise.points,
                                        &optimum_.noise.lines,
                                        &optimum_.noise.coplanar};
    KindAdjustment* const kinds[] = {&summary_.points, &summary_.lines,
                                     &summary_.coplanar};
    for (std::size_t k = 0; k < final.size(); ++k) {
      kinds[k]->final_rmse_px = final[k];
      kinds[k]->stddev_px = noises[k]->stddev_px;
      kinds[k]->threshold_px = noises[k]->threshold_px;
    }
    CountObservations(optimum_.state.points, &summary_.points);
    CountObservations(optimum_.state.lines, &summary_.lines);
    CountPairs(optimum_.state.pairs, scene_.coplanar_pairs.size(),
               &summary_.coplanar);
    summary_.initial_cost = summary_.solves.front().initial_cost;
    summary_.final_cost = optimum_.last.report.final_cost;
    summary_.converged = optimum_.at_rest && optimum_.last.report.converged;
    summary_.point_shape_exponent = optimum_.point_shape_exponent;
    summary_.planes = optimum_.state.planes.size();
    for (const PlaneState& plane : optimum_.state.planes) {
      summary_.landmarks_on_planes += plane.points.size() + plane.lines.size();
    }
    summary_.directions = optimum_.state.directions.size();
    summary_.components = optimum_.last.components;
    std::set<PoseId> adjusted;
    for (std::size_t n = 0; n < optimum_.cameras.poses.size(); ++n) {
      if (optimum_.last.pose_observed[n])
        adjusted.insert(optimum_.cameras.poses[n].id);
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
      summary_.calibration_preferences = FindCalibrationPreferences(
          options_, optimum_.noise, scene_, optimum_.cameras, optimum_.state);
    }
    if (options_.estimate_uncertainty) {
      LOWLAP_RETURN_IF_ERROR(EstimateUncertainty());
    }
    return summary_;
  }

  void WriteTo(Scene* scene, AdjustmentSummary* summary) const {
    optimum_.cameras.WriteTo(scene);
    for (auto& [id, pose] : scene->poses) {
      const auto found = center_covariances_.find(id);
      pose.center_covariance.reset();
      if (found != center_covariances_.end()) {
        pose.center_covariance = found->second;
      }
    }
    WriteLandmarks(optimum_.cameras, optimum_.state.points, &scene->structure,
                   summary);
    WriteLandmarks(optimum_.cameras, optimum_.state.lines,
                   &scene->line_structure, summary);
    scene->coplanar_pairs.clear();
    for (const PairState& pair : optimum_.state.pairs) {
      if (pair.consistent && optimum_.state.HasLines(pair)) {
        scene->coplanar_pairs.push_back({optimum_.state.lines[pair.first].id,
                                         optimum_.state.lines[pair.second].id});
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
    CenterUncertainty uncertainty =
        EstimateCenterUncertainty(options_, optimum_.noise, triplets, pairs,
                                  optimum_.cameras, optimum_.state);
    LOWLAP_RETURN_IF_ERROR(AddJackknife(options_, optimum_.noise, context_,
                                        optimum_.cameras, optimum_.state,
                                        &uncertainty));
    if (options_.test_calibration) {
      LOWLAP_RETURN_IF_ERROR(AddCalibrationShift(
          options_, optimum_.noise, summary_.calibration_preferences, scene_,
          context_, optimum_.cameras, optimum_.state, &uncertainty));
    }
    summary_.rivals = AddRivals(options_, rivals_, optimum_.cameras,
                                optimum_.state, &uncertainty);
    summary_.log_ratio_stddevs = std::move(uncertainty.log_ratio_stddevs);
    summary_.direction_stddevs_rad =
        std::move(uncertainty.direction_stddevs_rad);
    center_covariances_ = std::move(uncertainty.covariances);
    return {};
  }

  const AdjustmentOptions& options_;
  const RunContext& context_;
  const Scene& scene_;
  Optimum optimum_;
  std::vector<Rival> rivals_;
  AdjustmentSummary summary_;
  std::map<PoseId, Mat3> center_covariances_;
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
