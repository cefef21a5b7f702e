#include "lowlap/adjustment/internal/rounds/measurement_cost.h"

#include <algorithm>
#include <map>
#include <set>
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

using PosePair = std::pair<int, int>;

PosePair PosesOf(const CameraSet& cameras, const PointTrackState& point) {
  const int pose1 = cameras.views[point.candidates[0].view].pose;
  const int pose2 = cameras.views[point.candidates[1].view].pose;
  return std::minmax(pose1, pose2);
}

// Of relative poses that the cameras have left, the points that no third view
// sees.
std::vector<PointTrackState> PointsOfLostPairs(const CameraSet& cameras,
                                               const StructureState& state) {
  std::set<PosePair> lost;
  for (const RelativePosePrior& prior : state.priors) {
    if (!IsKept(prior, cameras)) {
      lost.insert(std::minmax(prior.first, prior.second));
    }
  }
  std::vector<PointTrackState> points;
  for (const PointTrackState& point : state.points) {
    if (point.candidates.size() == 2 &&
        lost.count(PosesOf(cameras, point)) > 0) {
      points.push_back(point);
    }
  }
  return points;
}

// At the landmarks that are best for them.
template <class Track>
Status TriangulateFreely(const CameraSet& cameras, const NoiseScale& noise,
                         const RunContext& context,
                         std::vector<Track>* tracks) {
  TriangulationLimits limits;
  limits.threshold_px = noise.threshold_px;
  limits.noise_px = noise.stddev_px;
  limits.max_relative_depth_stddev = kInfinity;
  limits.min_two_view_overlap = 0;
  return TriangulateAll(cameras, limits, context, tracks);
}

// Of a candidate that does not fit.
double Outside(const NoiseScale& noise) {
  return noise.threshold_px * noise.threshold_px /
         (noise.stddev_px * noise.stddev_px);
}

template <class Track>
Result<double> KindCost(const CameraSet& cameras, const NoiseScale& noise,
                        const RunContext& context, std::vector<Track> tracks) {
  LOWLAP_RETURN_IF_ERROR(TriangulateFreely(cameras, noise, context, &tracks));
  double cost = 0;
  for (const Track& track : tracks) {
    for (const auto& candidate : track.candidates) {
      const double error =
          candidate.used ? ErrorPx(cameras, track, candidate) / noise.stddev_px
                         : kInfinity;
      cost += std::min(error * error, Outside(noise));
    }
    if (!track.IsLandmark()) cost -= Outside(noise);
  }
  return Track::kResidualsPerError * cost;
}

// For every pair, those that do not fit less those that do.
Result<double> CostOfLostPairs(const CameraSet& cameras,
                               const NoiseScale& noise,
                               const RunContext& context,
                               std::vector<PointTrackState> points) {
  LOWLAP_RETURN_IF_ERROR(TriangulateFreely(cameras, noise, context, &points));
  std::map<PosePair, int> lost_less_kept;
  for (const PointTrackState& point : points) {
    lost_less_kept[PosesOf(cameras, point)] += point.IsLandmark() ? -1 : 1;
  }
  int lost = 0;
  for (const auto& entry : lost_less_kept) lost += std::max(entry.second, 0);
  return PointTrackState::kResidualsPerError * lost * Outside(noise);
}

}  // namespace

Result<double> MeasurementCost(const CameraSet& cameras,
                               const StructureState& state,
                               const NoiseLevels& noise,
                               double point_shape_exponent,
                               const RunContext& context) {
  std::vector<PointTrackState> points = SeenByMoreThanTwo(state.points);
  WhitenPoints(point_shape_exponent, &points);
  std::vector<PointTrackState> of_pairs = PointsOfLostPairs(cameras, state);
  WhitenPoints(point_shape_exponent, &of_pairs);
  LOWLAP_ASSIGN_OR_RETURN(
      const double of_points,
      KindCost(cameras, noise.points, context, std::move(points)));
  LOWLAP_ASSIGN_OR_RETURN(
      const double of_lines,
      KindCost(cameras, noise.lines, context, SeenByMoreThanTwo(state.lines)));
  LOWLAP_ASSIGN_OR_RETURN(
      const double of_lost_pairs,
      CostOfLostPairs(cameras, noise.points, context, std::move(of_pairs)));
  return of_points + of_lines + of_lost_pairs;
}

}  // namespace lowlap
