#include "lowlap/adjustment/internal/structure/structure_state.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "lowlap/core/internal/median.h"
#include "lowlap/robust/internal/median_deviation.h"

namespace lowlap {
namespace {

constexpr double kDefaultSegmentStddevPx = 0.5;

const LineSegment* FindSegment(const Scene& scene, const FeatureRef& ref) {
  const auto features = scene.features.find(ref.view);
  if (features == scene.features.end() ||
      ref.feature >= features->second.segments.size()) {
    return nullptr;
  }
  return &features->second.segments[ref.feature];
}

// Median noise level of the segments of all tracks: the scale of line errors.
double ReferenceStddevPx(const Scene& scene) {
  std::vector<double> stddevs;
  const auto add = [&](const Track& track) {
    for (const FeatureRef& ref : track) {
      const LineSegment* segment = FindSegment(scene, ref);
      if (segment != nullptr && segment->stddev_px > 0) {
        stddevs.push_back(segment->stddev_px);
      }
    }
  };
  for (const auto& [id, track] : scene.line_tracks) add(track);
  for (const auto& [id, line] : scene.line_structure) add(line.observations);
  if (stddevs.empty()) return kDefaultSegmentStddevPx;
  return Median(std::move(stddevs));
}

PointShape ShapeOf(const Scene& scene, ViewId view, FeatureIndex point) {
  const auto features = scene.features.find(view);
  if (features == scene.features.end() ||
      point >= features->second.point_covariances.size()) {
    return {};
  }
  return PointShape::FromCovariance(features->second.point_covariances[point]);
}

PointTrackState LoadPoint(const Scene& scene, const CameraSet& cameras,
                          PointTrackId id) {
  PointTrackState state;
  state.id = id;
  std::map<ViewId, PointCandidate> by_view;
  const auto add = [&](ViewId id_view, FeatureIndex feature,
                       const Vec2& pixel_px, bool used) {
    const int view = cameras.Find(id_view);
    if (view < 0) return;
    by_view[id_view] = {
        {view, feature, used}, pixel_px, ShapeOf(scene, id_view, feature)};
  };
  const auto track = scene.point_tracks.find(id);
  if (track != scene.point_tracks.end()) {
    for (const FeatureRef& ref : track->second) {
      add(ref.view, ref.feature,
          scene.features.at(ref.view).points_px[ref.feature], false);
    }
  }
  const auto landmark = scene.structure.find(id);
  if (landmark != scene.structure.end()) {
    state.position = landmark->second.position;
    for (const PointObservation& observation : landmark->second.observations) {
      add(observation.view, observation.feature, observation.pixel_px, true);
    }
  }
  for (const auto& [view, candidate] : by_view) {
    state.candidates.push_back(candidate);
  }
  if (state.PoseCount(cameras) >= 2) state.status = LandmarkStatus::kLandmark;
  return state;
}

LineTrackState LoadLine(const Scene& scene, const CameraSet& cameras,
                        LineTrackId id, double reference_stddev_px,
                        bool with_intrinsic_derivatives) {
  LineTrackState state;
  state.id = id;
  std::map<FeatureRef, bool> used_by_ref;
  const auto track = scene.line_tracks.find(id);
  if (track != scene.line_tracks.end()) {
    for (const FeatureRef& ref : track->second) used_by_ref[ref] = false;
  }
  const auto landmark = scene.line_structure.find(id);
  if (landmark != scene.line_structure.end()) {
    const LineLandmark& line = landmark->second;
    for (const FeatureRef& ref : line.observations) used_by_ref[ref] = true;
    state.direction = line.line.direction.normalized();
    state.point = line.line.ClosestPointTo(0.5 * (line.start + line.end));
    const double half = 0.5 * (line.end - line.start).norm();
    state.low = -half;
    state.high = half;
  }
  for (const auto& [ref, used] : used_by_ref) {
    const int view = cameras.Find(ref.view);
    const LineSegment* segment = FindSegment(scene, ref);
    if (view < 0 || segment == nullptr) continue;
    const std::optional<SegmentRays> rays = MakeSegmentRays(
        *segment, cameras.IntrinsicOf(view), with_intrinsic_derivatives);
    if (!rays) continue;
    LineCandidate candidate{{view, ref.feature, used}, *rays};
    constexpr double kMaxWeight = 4;  // detectors do not know their noise well
    if (segment->stddev_px > 0) {
      candidate.weight = std::clamp(reference_stddev_px / segment->stddev_px,
                                    1 / kMaxWeight, kMaxWeight);
    }
    state.candidates.push_back(candidate);
  }
  if (state.PoseCount(cameras) >= 2) state.status = LandmarkStatus::kLandmark;
  return state;
}

template <class Track>
std::vector<double> ErrorsPx(const CameraSet& cameras,
                             const std::vector<Track>& tracks) {
  std::vector<double> errors_px;
  for (const Track& track : tracks) {
    const int measurements = 2 * static_cast<int>(track.UsedCount());
    const int redundancy = measurements - Track::kUnknowns;
    if (!track.IsLandmark() || redundancy <= 0) continue;
    const double factor =
        std::sqrt(static_cast<double>(measurements) / redundancy);
    for (const auto& candidate : track.candidates) {
      errors_px.push_back(factor * ErrorPx(cameras, track, candidate));
    }
  }
  return errors_px;
}

// Of all tracks and all landmarks.
template <class Tracks, class Landmarks>
auto AllIds(const Tracks& tracks, const Landmarks& landmarks) {
  std::set<typename Tracks::key_type> ids;
  for (const auto& [id, track] : tracks) ids.insert(id);
  for (const auto& [id, landmark] : landmarks) ids.insert(id);
  return ids;
}

template <class Track>
void CountUsed(const std::vector<Track>& tracks, std::size_t* by_two,
               std::size_t* by_more) {
  for (const Track& track : tracks) {
    if (!track.IsLandmark()) continue;
    const std::size_t used = track.UsedCount();
    *(used > 2 ? by_more : by_two) += used;
  }
}

}  // namespace

std::vector<PointTrackState> LoadPoints(const Scene& scene,
                                        const CameraSet& cameras) {
  std::vector<PointTrackState> points;
  for (const PointTrackId id : AllIds(scene.point_tracks, scene.structure)) {
    points.push_back(LoadPoint(scene, cameras, id));
  }
  return points;
}

std::vector<LineTrackState> LoadLines(const Scene& scene,
                                      const CameraSet& cameras,
                                      bool with_intrinsic_derivatives) {
  const double reference_stddev_px = ReferenceStddevPx(scene);
  std::vector<LineTrackState> lines;
  for (const LineTrackId id : AllIds(scene.line_tracks, scene.line_structure)) {
    lines.push_back(LoadLine(scene, cameras, id, reference_stddev_px,
                             with_intrinsic_derivatives));
  }
  return lines;
}

std::vector<PairState> LoadPairs(const Scene& scene,
                                 const std::vector<LineTrackState>& lines) {
  std::map<LineTrackId, int> index;
  for (std::size_t n = 0; n < lines.size(); ++n) {
    if (lines[n].IsLandmark()) index[lines[n].id] = static_cast<int>(n);
  }
  std::vector<PairState> pairs;
  for (const CoplanarPair& pair : scene.coplanar_pairs) {
    const auto first = index.find(pair.first), second = index.find(pair.second);
    if (first == index.end() || second == index.end()) continue;
    pairs.push_back({first->second, second->second});
  }
  return pairs;
}

void RefreshRays(const Scene& scene, const CameraSet& cameras,
                 StructureState* state) {
  for (LineTrackState& line : state->lines) {
    for (LineCandidate& candidate : line.candidates) {
      const LineSegment& segment =
          scene.features.at(cameras.views[candidate.view].id)
              .segments[candidate.feature];
      const std::optional<SegmentRays> rays =
          MakeSegmentRays(segment, cameras.IntrinsicOf(candidate.view), true);
      if (rays) candidate.rays = *rays;
    }
  }
}

bool MostAreSeenTwice(const StructureState& state) {
  std::size_t by_two = 0;
  std::size_t by_more = 0;
  CountUsed(state.points, &by_two, &by_more);
  CountUsed(state.lines, &by_two, &by_more);
  return by_two > by_more;
}

Landmark ToLandmark(const CameraSet& cameras, const PointTrackState& track) {
  Landmark landmark;
  landmark.position = track.position;
  for (const PointCandidate& candidate : track.candidates) {
    if (!candidate.used) continue;
    landmark.observations.push_back({cameras.views[candidate.view].id,
                                     candidate.feature, candidate.pixel_px});
  }
  return landmark;
}

LineLandmark ToLandmark(const CameraSet& cameras, const LineTrackState& track) {
  LineLandmark landmark;
  landmark.line =
      PluckerLine::FromPointAndDirection(track.point, track.direction);
  landmark.start = track.point + track.low * track.direction;
  landmark.end = track.point + track.high * track.direction;
  for (const LineCandidate& candidate : track.candidates) {
    if (!candidate.used) continue;
    landmark.observations.push_back(
        {cameras.views[candidate.view].id, candidate.feature});
  }
  return landmark;
}

NoiseScale EstimateNoise(const CameraSet& cameras,
                         const std::vector<PointTrackState>& points,
                         const NoiseBounds& bounds) {
  return EstimateNoise(ErrorsPx(cameras, points), cameras.PointToPoint(),
                       kMedianOfNorm<2>, bounds);
}

NoiseScale EstimateNoise(const CameraSet& cameras,
                         const std::vector<LineTrackState>& lines,
                         const NoiseBounds& bounds) {
  // The root mean square of two distances, not their length.
  return EstimateNoise(ErrorsPx(cameras, lines), cameras.PointToLine(),
                       kMedianOfNorm<2> / std::sqrt(2.0), bounds);
}

}  // namespace lowlap
