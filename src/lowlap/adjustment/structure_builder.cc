#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/adjustment/internal/structure/coplanar_pairs.h"
#include "lowlap/adjustment/internal/structure/structure_state.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/scene/validation.h"

namespace lowlap {
namespace {

// Median of the thresholds that the relative poses were verified with; 0 if
// they have none.
double VerificationThresholdPx(const Scene& scene) {
  std::vector<double> thresholds;
  for (const auto& [views, edge] : scene.relative_poses) {
    if (edge.point_threshold_px > 0) {
      thresholds.push_back(edge.point_threshold_px);
    }
  }
  return Median(std::move(thresholds));
}

// Noise of the images, as far as it is known before the poses are good: a
// threshold lies at about three standard deviations.
double ImageNoisePx(double verification_threshold_px) {
  constexpr double kDefaultNoisePx = 0.7;
  return verification_threshold_px > 0
             ? std::clamp(verification_threshold_px / 3, 0.2, 3.0)
             : kDefaultNoisePx;
}

template <class TrackState>
void Summarise(const std::vector<TrackState>& tracks, const CameraSet& cameras,
               TriangulationSummary* summary) {
  summary->tracks = tracks.size();
  for (const TrackState& track : tracks) {
    summary->observations += track.candidates.size();
    switch (track.status) {
      case LandmarkStatus::kLandmark: {
        ++summary->landmarks;
        std::set<int> poses;
        for (const auto& candidate : track.candidates) {
          if (candidate.used) poses.insert(cameras.views[candidate.view].pose);
        }
        if (poses.size() == 2) ++summary->two_view_landmarks;
        const std::size_t used = track.UsedCount();
        summary->observations_used += used;
        summary->observations_dropped += track.candidates.size() - used;
        break;
      }
      case LandmarkStatus::kTooFewViews:
        ++summary->too_few_views;
        break;
      case LandmarkStatus::kInconsistent:
        ++summary->inconsistent;
        break;
      case LandmarkStatus::kBehindCamera:
        ++summary->behind_camera;
        break;
      case LandmarkStatus::kUncertain:
        ++summary->uncertain;
        break;
      case LandmarkStatus::kImplausible:
        ++summary->implausible;
        break;
    }
  }
}

Status BuildPoints(const CameraSet& cameras, const StructureOptions& options,
                   double verification_px, const RunContext& context,
                   std::vector<PointTrackState>* points, double* threshold_px) {
  const std::vector<std::size_t> all = AllOf(points->size());
  PointTriangulationLimits limits;
  limits.noise_px = ImageNoisePx(verification_px);
  limits.max_relative_depth_stddev = options.max_relative_depth_stddev;
  if (options.max_point_error_px > 0) {
    limits.threshold_px = options.max_point_error_px;
  } else {
    // From all observations of every track, whatever its errors, one sees how
    // far the poses let true observations stray.
    LOWLAP_RETURN_IF_ERROR(
        TriangulatePoints(cameras, limits, context, all, points));
    NoiseBounds bounds;
    bounds.fallback = {limits.noise_px, 3 * limits.noise_px};
    const NoiseScale noise = EstimatePointNoise(cameras, *points, bounds);
    limits.threshold_px = std::max(noise.threshold_px, verification_px);
  }
  *threshold_px = limits.threshold_px;
  return TriangulatePoints(cameras, limits, context, all, points);
}

Status BuildLines(const CameraSet& cameras, const StructureOptions& options,
                  double verification_px, const RunContext& context,
                  std::vector<LineTrackState>* lines, double* threshold_px) {
  const std::vector<std::size_t> all = AllOf(lines->size());
  LineTriangulationLimits limits;
  limits.noise_px = ImageNoisePx(verification_px);
  limits.max_relative_depth_stddev = options.max_relative_line_depth_stddev;
  limits.min_two_view_overlap = options.min_two_view_line_overlap;
  if (options.max_line_error_px > 0) {
    limits.threshold_px = options.max_line_error_px;
  } else {
    LOWLAP_RETURN_IF_ERROR(
        TriangulateLines(cameras, limits, context, all, lines));
    NoiseBounds bounds;
    bounds.fallback = {limits.noise_px, 3 * limits.noise_px};
    const NoiseScale noise = EstimateLineNoise(cameras, *lines, bounds);
    limits.threshold_px = std::max(noise.threshold_px, verification_px);
  }
  *threshold_px = limits.threshold_px;
  return TriangulateLines(cameras, limits, context, all, lines);
}

}  // namespace

Status StructureOptions::Validate() const {
  const auto invalid = [](const std::string& name) {
    return MakeError(ErrorCode::kInvalidArgument,
                     name + " must be finite and not negative");
  };
  for (const auto& [value, name] :
       {std::pair(max_point_error_px, "max_point_error_px"),
        std::pair(max_line_error_px, "max_line_error_px"),
        std::pair(max_relative_depth_stddev, "max_relative_depth_stddev"),
        std::pair(max_relative_line_depth_stddev,
                  "max_relative_line_depth_stddev"),
        std::pair(min_two_view_line_overlap, "min_two_view_line_overlap"),
        std::pair(min_coplanar_angle_deg, "min_coplanar_angle_deg")}) {
    if (!(value >= 0) || !std::isfinite(value)) return invalid(name);
  }
  return {};
}

Result<StructureSummary> BuildStructure(Scene* scene,
                                        const StructureOptions& options,
                                        const RunContext& context) {
  const auto start = std::chrono::steady_clock::now();
  if (scene == nullptr) {
    return MakeError(ErrorCode::kInvalidArgument, "the scene is null");
  }
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  LOWLAP_RETURN_IF_ERROR(ValidateScene(*scene));

  StructureSummary summary;
  const CameraSet cameras(*scene);
  const double verification_px = VerificationThresholdPx(*scene);
  std::map<PointTrackId, Landmark> structure;
  std::map<LineTrackId, LineLandmark> line_structure;
  std::vector<CoplanarPair> coplanar_pairs;

  if (!context.Progress("structure", 0, 2)) {
    return MakeError(ErrorCode::kCancelled, "stopped on request");
  }
  if (options.use_points) {
    std::vector<PointTrackState> points = LoadPoints(*scene, cameras);
    LOWLAP_RETURN_IF_ERROR(BuildPoints(cameras, options, verification_px,
                                       context, &points,
                                       &summary.points.threshold_px));
    Summarise(points, cameras, &summary.points);
    for (const PointTrackState& track : points) {
      if (track.IsLandmark()) {
        structure.emplace(track.id, ToLandmark(cameras, track));
      }
    }
  }
  if (!context.Progress("structure", 1, 2)) {
    return MakeError(ErrorCode::kCancelled, "stopped on request");
  }
  if (options.use_lines) {
    std::vector<LineTrackState> lines = LoadLines(*scene, cameras, false);
    LOWLAP_RETURN_IF_ERROR(BuildLines(cameras, options, verification_px,
                                      context, &lines,
                                      &summary.lines.threshold_px));
    Summarise(lines, cameras, &summary.lines);
    for (const LineTrackState& track : lines) {
      if (track.IsLandmark()) {
        line_structure.emplace(track.id, ToLandmark(cameras, track));
      }
    }
    if (options.use_coplanar) {
      coplanar_pairs = CollectCoplanarPairs(
          scene->scale_ratios, line_structure,
          RadFromDeg(options.min_coplanar_angle_deg), &summary);
    }
  }
  scene->structure = std::move(structure);
  scene->line_structure = std::move(line_structure);
  scene->coplanar_pairs = std::move(coplanar_pairs);
  context.Progress("structure", 2, 2);
  summary.seconds =
      std::chrono::duration<double>(std::chrono::steady_clock::now() - start)
          .count();
  context.Log(LogLevel::kInfo,
              "structure: " + std::to_string(summary.points.landmarks) +
                  " of " + std::to_string(summary.points.tracks) +
                  " point tracks, " + std::to_string(summary.lines.landmarks) +
                  " of " + std::to_string(summary.lines.tracks) +
                  " line tracks, " + std::to_string(summary.coplanar_pairs) +
                  " coplanar pairs");
  return summary;
}

}  // namespace lowlap
