#include "lowlap/adjustment/internal/planes/free_landmark.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

FreePlace PlaceOnLine(const LineEstimate& line, double along, double noise_px) {
  // dP = B (a + s b), see LineEstimate.
  Eigen::Matrix<double, 2, 4> by_unknowns;
  by_unknowns << Mat2::Identity(), along * Mat2::Identity();
  const Eigen::Matrix<double, 3, 4> jacobian =
      TangentBasis(line.direction) * by_unknowns;
  return {line.point + along * line.direction, noise_px * noise_px * jacobian *
                                                   line.unit_covariance *
                                                   jacobian.transpose()};
}

template <class Track>
std::vector<int> PosesOf(const CameraSet& cameras, const Track& track) {
  std::vector<int> poses;
  for (const auto& candidate : track.candidates) {
    if (candidate.used) poses.push_back(cameras.views[candidate.view].pose);
  }
  std::sort(poses.begin(), poses.end());
  poses.erase(std::unique(poses.begin(), poses.end()), poses.end());
  return poses;
}

}  // namespace

Vec3 FreeLandmark::Center() const {
  Vec3 sum = Vec3::Zero();
  for (const FreePlace& place : places) sum += place.point;
  return sum / static_cast<double>(places.size());
}

std::vector<FreeLandmark> FreeLandmarks(const AdjustmentOptions& options,
                                        const NoiseLevels& noise,
                                        const CameraSet& cameras,
                                        const StructureState& state) {
  std::vector<FreeLandmark> landmarks;
  for (std::size_t n = 0; n < state.points.size(); ++n) {
    if (!options.use_points || !state.points[n].IsLandmark()) continue;
    const std::optional<PointEstimate> point =
        EstimateFromPixels(cameras, state.points[n]);
    if (!point) continue;
    const double variance = noise.points.stddev_px * noise.points.stddev_px;
    landmarks.push_back({false,
                         static_cast<int>(n),
                         {{point->position, variance * point->unit_covariance}},
                         PosesOf(cameras, state.points[n])});
  }
  for (std::size_t n = 0; n < state.lines.size(); ++n) {
    const LineTrackState& track = state.lines[n];
    if (!track.IsLandmark()) continue;
    const std::optional<LineEstimate> line =
        EstimateFromSegments(cameras, track);
    if (!line) continue;
    // The extent, carried over to the estimate.
    const auto place_at = [&](double along) {
      const Vec3 end = track.point + along * track.direction;
      return PlaceOnLine(*line, line->direction.dot(end - line->point),
                         noise.lines.stddev_px);
    };
    landmarks.push_back({true,
                         static_cast<int>(n),
                         {place_at(track.low), place_at(track.high)},
                         PosesOf(cameras, track)});
  }
  return landmarks;
}

}  // namespace lowlap
