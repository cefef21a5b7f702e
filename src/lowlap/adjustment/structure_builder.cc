#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/adjustment/bundle_adjuster.h"
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

// In the order of LandmarkStatus.
constexpr std::size_t TriangulationSummary::*kCounters[] = {
    &TriangulationSummary::landmarks,    &TriangulationSummary::too_few_views,
    &TriangulationSummary::inconsistent, &TriangulationSummary::behind_camera,
    &TriangulationSummary::uncertain,    &TriangulationSummary::implausible};

template <class Track>
void Summarise(const std::vector<Track>& tracks, const CameraSet& cameras,
               TriangulationSummary* summary) {
  summary->tracks = tracks.size();
  for (const Track& track : tracks) {
    summary->observations += track.candidates.size();
    ++(summary->*kCounters[static_cast<std::size_t>(track.status)]);
    if (!track.IsLandmark()) continue;
    if (track.PoseCount(cameras) == 2) ++summary->two_view_landmarks;
    summary->observations_used += track.UsedCount();
    summary->observations_dropped +=
        track.candidates.size() - track.UsedCount();
  }
}

// `max_error_px` as in the options.
template <class Track, class Landmarks>
Status BuildLandmarks(const CameraSet& cameras, const StructureOptions& options,
                      double max_error_px, double verification_px,
                      const RunContext& context, std::vector<Track> tracks,
                      Landmarks* landmarks, TriangulationSummary* summary) {
  const double noise_px = ImageNoisePx(verification_px);
  TriangulationLimits limits =
      LimitsOf<Track>(options, NoiseScale{noise_px, kInfinity});
  if (max_error_px > 0) {
    limits.threshold_px = max_error_px;
  } else {
    // From all observations of every track, whatever its errors, one sees how
    // far the poses let true observations stray.
    LOWLAP_RETURN_IF_ERROR(TriangulateAll(cameras, limits, context, &tracks));
    NoiseBounds bounds;
    bounds.fallback = {noise_px, 3 * noise_px};
    limits.threshold_px = std::max(
        EstimateNoise(cameras, tracks, bounds).threshold_px, verification_px);
  }
  summary->threshold_px = limits.threshold_px;
  LOWLAP_RETURN_IF_ERROR(TriangulateAll(cameras, limits, context, &tracks));
  Summarise(tracks, cameras, summary);
  for (const Track& track : tracks) {
    if (track.IsLandmark()) {
      landmarks->emplace(track.id, ToLandmark(cameras, track));
    }
  }
  return {};
}

// Lines by the segments that observe them. A segment belongs to more than one
// only if tracks overlap.
using LinesBySegment = std::map<FeatureRef, std::vector<LineTrackId>>;

bool SeenIn(const LineLandmark& line, ViewId view) {
  return std::any_of(line.observations.begin(), line.observations.end(),
                     [&](const FeatureRef& ref) { return ref.view == view; });
}

// The line of a segment that the other view of its match sees too.
LineTrackId FindLine(const LinesBySegment& by_segment,
                     const std::map<LineTrackId, LineLandmark>& lines,
                     const FeatureRef& segment, ViewId other) {
  const auto found = by_segment.find(segment);
  if (found == by_segment.end()) return kInvalidId;
  for (const LineTrackId id : found->second) {
    if (SeenIn(lines.at(id), other)) return id;
  }
  return kInvalidId;
}

// The coplanar inliers of the meaningful ratios as pairs of line landmarks:
// each line is the one that holds the inlier's segment of the middle view.
// Unique and ordered; counts what is left out in `summary`.
std::vector<CoplanarPair> CollectCoplanarPairs(
    const std::vector<ScaleRatio>& ratios,
    const std::map<LineTrackId, LineLandmark>& lines, double min_angle_rad,
    StructureSummary* summary) {
  LinesBySegment by_segment;
  for (const auto& [id, line] : lines) {
    for (const FeatureRef& ref : line.observations) {
      by_segment[ref].push_back(id);
    }
  }
  std::set<CoplanarPair> pairs;
  for (const ScaleRatio& ratio : ratios) {
    if (ratio.verdict != RatioVerdict::kMeaningful) continue;
    const auto& [first, middle, last] = ratio.views;
    for (const CoplanarInlier& inlier : ratio.coplanar_inliers) {
      ++summary->coplanar_inliers;
      LineTrackId a =
          FindLine(by_segment, lines, {middle, inlier.line_in_first}, first);
      LineTrackId b =
          FindLine(by_segment, lines, {middle, inlier.line_in_last}, last);
      if (a == kInvalidId || b == kInvalidId) {
        ++summary->coplanar_without_lines;
        continue;
      }
      const double sine =
          lines.at(a).line.direction.cross(lines.at(b).line.direction).norm();
      if (a == b || sine < std::sin(min_angle_rad)) {
        ++summary->coplanar_parallel;
        continue;
      }
      if (a > b) std::swap(a, b);
      if (!pairs.insert({a, b}).second) ++summary->coplanar_duplicates;
    }
  }
  summary->coplanar_pairs = pairs.size();
  return {pairs.begin(), pairs.end()};
}

}  // namespace

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
    LOWLAP_RETURN_IF_ERROR(BuildLandmarks(
        cameras, options, options.max_point_error_px, verification_px, context,
        LoadPoints(*scene, cameras), &structure, &summary.points));
  }
  if (!context.Progress("structure", 1, 2)) {
    return MakeError(ErrorCode::kCancelled, "stopped on request");
  }
  if (options.use_lines) {
    LOWLAP_RETURN_IF_ERROR(BuildLandmarks(
        cameras, options, options.max_line_error_px, verification_px, context,
        LoadLines(*scene, cameras, false), &line_structure, &summary.lines));
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
