#include "lowlap/adjustment/internal/rounds/outlier_round.h"

#include <algorithm>
#include <utility>

#include "lowlap/adjustment/internal/rounds/pairs.h"
#include "lowlap/adjustment/internal/rounds/problem_selection.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

template <class Track>
std::size_t CountChanges(const Track& before, const Track& after) {
  std::size_t changed = 0;
  for (std::size_t n = 0; n < before.candidates.size(); ++n) {
    changed += before.candidates[n].used != after.candidates[n].used ? 1 : 0;
  }
  return changed;
}

// What fits the landmark as it is, or a fresh one that more candidates fit.
template <class Track>
Track Updated(const CameraSet& cameras, const TriangulationLimits& limits,
              const Track& before) {
  Track kept = before;
  if (kept.IsLandmark()) {
    for (auto& candidate : kept.candidates) {
      candidate.used = ErrorPx(cameras, kept, candidate) <= limits.threshold_px;
    }
    if (kept.PoseCount(cameras) < 2) {
      kept.Abandon(LandmarkStatus::kInconsistent);
    } else if (kept.UsedCount() == kept.candidates.size()) {
      return kept;
    }
  }
  Track fresh = before;
  Triangulate(cameras, limits, &fresh);
  return fresh.IsLandmark() && fresh.UsedCount() > kept.UsedCount() ? fresh
                                                                    : kept;
}

// Those that are not `solved` follow the poses, and count where three poses see
// them.
template <class Track>
Status UpdateTracks(const CameraSet& cameras, const TriangulationLimits& limits,
                    double gate, const std::vector<char>& solved,
                    const RunContext& context, std::vector<Track>* tracks,
                    ObservationChanges* changes) {
  TriangulationLimits wide = limits;
  wide.threshold_px *= gate;
  std::vector<Track> updated = *tracks;
  const Status status =
      ParallelFor(context, {}, updated.size(), [&](std::size_t n) {
        const bool redundant = updated[n].candidates.size() > 2;
        const TriangulationLimits& used = redundant ? wide : limits;
        if (solved[n]) {
          updated[n] = Updated(cameras, used, (*tracks)[n]);
        } else {
          Triangulate(cameras, used, &updated[n]);
        }
      });
  if (!status) return status;
  for (std::size_t n = 0; n < updated.size(); ++n) {
    if (solved[n] || updated[n].PoseCount(cameras) > 2) {
      changes->changed += CountChanges((*tracks)[n], updated[n]);
      changes->total += updated[n].candidates.size();
    }
  }
  *tracks = std::move(updated);
  return {};
}

NoiseBounds BoundsOf(const AdjustmentOptions& options) {
  NoiseBounds bounds;
  bounds.min_threshold_px = options.min_threshold_px;
  bounds.max_threshold_px = options.max_threshold_px;
  return bounds;
}

std::vector<char> SolvedLines(const AdjustmentOptions& options,
                              const CameraSet& cameras,
                              const StructureState& state) {
  std::vector<char> solved(state.lines.size(), 0);
  for (const int n : SelectForSolve(cameras, state, options).lines) {
    solved[n] = 1;
  }
  return solved;
}

// The errors of a kind that is off are known once it has followed: first at any
// error, then at the threshold that these errors have.
template <class Track>
Status FollowFreely(const AdjustmentOptions& options, const RunContext& context,
                    const CameraSet& cameras, std::vector<Track>* tracks) {
  NoiseScale noise{1, kInfinity};
  Status status =
      TriangulateAll(cameras, LimitsOf<Track>(options, noise), context, tracks);
  if (!status) return status;
  noise = EstimateNoise(cameras, *tracks, BoundsOf(options));
  return TriangulateAll(cameras, LimitsOf<Track>(options, noise), context,
                        tracks);
}

}  // namespace

Status FollowPoses(const AdjustmentOptions& options,
                   const NoiseScale& line_noise, const RunContext& context,
                   const CameraSet& cameras, StructureState* state) {
  if (!options.use_points) {
    Status status = FollowFreely(options, context, cameras, &state->points);
    if (!status) return status;
  }
  if (!options.use_lines) {
    return FollowFreely(options, context, cameras, &state->lines);
  }
  return TriangulateAll(cameras, LimitsOf<LineTrackState>(options, line_noise),
                        context, &state->lines,
                        SolvedLines(options, cameras, *state));
}

NoiseLevels EstimateAllNoise(const CameraSet& cameras,
                             const StructureState& state,
                             const AdjustmentOptions& options) {
  NoiseBounds bounds = BoundsOf(options);
  NoiseLevels noise;
  noise.points = EstimateNoise(cameras, state.points, bounds);
  // Few lines of three views: they are taken to be about as good as points.
  bounds.fallback.stddev_px =
      std::max(bounds.fallback.stddev_px, noise.points.stddev_px);
  bounds.fallback.threshold_px =
      std::max(bounds.fallback.threshold_px, noise.points.threshold_px);
  noise.lines = EstimateNoise(cameras, state.lines, bounds);
  noise.coplanar = EstimatePairNoise(cameras, ComputePairGaps(cameras, state),
                                     noise.lines, bounds);
  return noise;
}

Result<ObservationChanges> UpdateObservations(const AdjustmentOptions& options,
                                              const NoiseLevels& noise,
                                              const ObservationUpdate& update,
                                              const RunContext& context,
                                              const CameraSet& cameras,
                                              StructureState* state) {
  ObservationChanges changes;
  if (options.use_points) {
    LOWLAP_RETURN_IF_ERROR(
        UpdateTracks(cameras, LimitsOf<PointTrackState>(options, noise.points),
                     update.gate, std::vector<char>(state->points.size(), 1),
                     context, &state->points, &changes));
  }
  if (!options.use_lines) return changes;
  LOWLAP_RETURN_IF_ERROR(UpdateTracks(
      cameras, LimitsOf<LineTrackState>(options, noise.lines), update.gate,
      SolvedLines(options, cameras, *state), context, &state->lines, &changes));
  if (!options.use_coplanar) return changes;
  changes.changed += SelectPairs(options, cameras, noise.coplanar.threshold_px,
                                 update.take_new_pairs, state);
  changes.total += state->pairs.size();
  return changes;
}

}  // namespace lowlap
