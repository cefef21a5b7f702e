#include "lowlap/adjustment/internal/rounds/measurement_cost.h"

#include <algorithm>
#include <utility>
#include <vector>

#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

template <class Track>
std::vector<Track> SeenByMoreThanTwo(const std::vector<Track>& tracks) {
  std::vector<Track> redundant;
  for (const Track& track : tracks) {
    if (track.candidates.size() > 2) redundant.push_back(track);
  }
  return redundant;
}

template <class Track>
Result<double> KindCost(const CameraSet& cameras, const NoiseScale& noise,
                        const RunContext& context, std::vector<Track> tracks) {
  TriangulationLimits limits;
  limits.threshold_px = noise.threshold_px;
  limits.noise_px = noise.stddev_px;
  limits.max_relative_depth_stddev = kInfinity;
  limits.min_two_view_overlap = 0;
  LOWLAP_RETURN_IF_ERROR(TriangulateAll(cameras, limits, context, &tracks));
  const double outside = noise.threshold_px * noise.threshold_px;
  double squares = 0;
  for (const Track& track : tracks) {
    for (const auto& candidate : track.candidates) {
      const double error_px =
          candidate.used ? ErrorPx(cameras, track, candidate) : kInfinity;
      squares += std::min(error_px * error_px, outside);
    }
    if (!track.IsLandmark()) squares -= outside;
  }
  return Track::kResidualsPerError * squares /
         (noise.stddev_px * noise.stddev_px);
}

}  // namespace

Result<double> MeasurementCost(const CameraSet& cameras,
                               const StructureState& state,
                               const NoiseLevels& noise,
                               double point_shape_exponent,
                               const RunContext& context) {
  std::vector<PointTrackState> points = SeenByMoreThanTwo(state.points);
  WhitenPoints(point_shape_exponent, &points);
  LOWLAP_ASSIGN_OR_RETURN(
      const double of_points,
      KindCost(cameras, noise.points, context, std::move(points)));
  LOWLAP_ASSIGN_OR_RETURN(
      const double of_lines,
      KindCost(cameras, noise.lines, context, SeenByMoreThanTwo(state.lines)));
  return of_points + of_lines;
}

}  // namespace lowlap
