#include "lowlap/adjustment/internal/rounds/measurement_cost.h"

#include <utility>
#include <vector>

#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

template <class Track>
Result<double> KindCost(const CameraSet& cameras, const NoiseScale& noise,
                        const RunContext& context, std::vector<Track> tracks) {
  TriangulationLimits limits;
  limits.threshold_px = noise.threshold_px;
  limits.noise_px = noise.stddev_px;
  limits.max_relative_depth_stddev = kInfinity;
  limits.min_two_view_overlap = 0;
  LOWLAP_RETURN_IF_ERROR(TriangulateAll(cameras, limits, context, &tracks));
  double squares = 0;
  for (const Track& track : tracks) {
    if (track.candidates.size() <= 2) continue;
    const bool known = track.IsLandmark();
    std::size_t outside = 0;
    for (const auto& candidate : track.candidates) {
      if (known && candidate.used) {
        const double error_px = ErrorPx(cameras, track, candidate);
        squares += error_px * error_px;
      } else {
        ++outside;
      }
    }
    if (!known && outside > 0) --outside;
    squares +=
        static_cast<double>(outside) * noise.threshold_px * noise.threshold_px;
  }
  return squares / (noise.stddev_px * noise.stddev_px);
}

}  // namespace

Result<double> MeasurementCost(const CameraSet& cameras,
                               const StructureState& state,
                               const NoiseLevels& noise,
                               const RunContext& context) {
  LOWLAP_ASSIGN_OR_RETURN(const double points, KindCost(cameras, noise.points,
                                                        context, state.points));
  LOWLAP_ASSIGN_OR_RETURN(const double lines,
                          KindCost(cameras, noise.lines, context, state.lines));
  return points + lines;
}

}  // namespace lowlap
