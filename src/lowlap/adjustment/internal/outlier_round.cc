#include "lowlap/adjustment/internal/outlier_round.h"

#include <algorithm>
#include <utility>

#include "lowlap/adjustment/internal/pair_terms.h"
#include "lowlap/adjustment/internal/problem_selection.h"
#include "lowlap/core/parallel.h"

namespace lowlap::internal {
namespace {

template <class Track>
std::size_t CountChanges(const Track& before, const Track& after) {
  std::size_t changed = 0;
  for (std::size_t n = 0; n < before.candidates.size(); ++n) {
    changed += before.candidates[n].used != after.candidates[n].used ? 1 : 0;
  }
  return changed;
}

template <class Track>
void Abandon(Fate fate, Track* track) {
  for (auto& candidate : track->candidates) candidate.used = false;
  track->fate = fate;
}

// Marks what fits the landmark as it is; true if that is every candidate.
bool MarkFitting(const CameraSet& cameras, double threshold_px,
                 PointTrackState* track) {
  bool all = true;
  for (PointCandidate& candidate : track->candidates) {
    candidate.used =
        PointErrorPx(cameras, candidate, track->position) <= threshold_px;
    all = all && candidate.used;
  }
  return all;
}

bool MarkFitting(const CameraSet& cameras, double threshold_px,
                 LineTrackState* track) {
  bool all = true;
  for (LineCandidate& candidate : track->candidates) {
    candidate.used = LineErrorPx(cameras, candidate, track->point,
                                 track->direction) <= threshold_px;
    all = all && candidate.used;
  }
  return all;
}

PointTrackState UpdatePoint(const CameraSet& cameras,
                            const PointTriangulationLimits& limits,
                            const PointTrackState& before) {
  PointTrackState kept = before;
  if (kept.IsLandmark()) {
    const bool all = MarkFitting(cameras, limits.threshold_px, &kept);
    if (!kept.HasTwoPoses(cameras)) {
      Abandon(Fate::kInconsistent, &kept);
    } else if (all) {
      return kept;
    }
  }
  PointTrackState fresh = before;
  TriangulatePointTrack(cameras, limits, &fresh);
  return fresh.IsLandmark() && fresh.UsedCount() > kept.UsedCount() ? fresh
                                                                    : kept;
}

LineTrackState UpdateLine(const CameraSet& cameras,
                          const LineTriangulationLimits& limits, bool solved,
                          const LineTrackState& before) {
  LineTrackState kept = before;
  if (kept.IsLandmark() && solved) {
    const bool all = MarkFitting(cameras, limits.threshold_px, &kept);
    if (kept.PoseCount(cameras) < 2) {
      Abandon(Fate::kInconsistent, &kept);
    } else if (all) {
      return kept;
    }
  } else {
    Abandon(kept.fate, &kept);
  }
  LineTrackState fresh = before;
  TriangulateLineTrack(cameras, limits, &fresh);
  return (fresh.IsLandmark() && fresh.UsedCount() > kept.UsedCount()) || !solved
             ? fresh
             : kept;
}

}  // namespace

NoiseLevels EstimateAllNoise(const CameraSet& cameras,
                             const StructureState& state,
                             const AdjustmentOptions& options) {
  NoiseBounds bounds;
  bounds.min_threshold_px = options.min_threshold_px;
  bounds.max_threshold_px = options.max_threshold_px;
  NoiseLevels noise;
  noise.points = EstimatePointNoise(cameras, state.points, bounds);
  // Few lines of three views: they are taken to be about as good as points.
  bounds.fallback.stddev_px =
      std::max(bounds.fallback.stddev_px, noise.points.stddev_px);
  bounds.fallback.threshold_px =
      std::max(bounds.fallback.threshold_px, noise.points.threshold_px);
  noise.lines = EstimateLineNoise(cameras, state.lines, bounds);
  noise.coplanar = EstimatePairNoise(cameras, state, options.coplanar_residual,
                                     noise.lines, bounds);
  return noise;
}

Result<ObservationChanges> UpdateObservations(const AdjustmentOptions& options,
                                              const NoiseLevels& noise,
                                              const RunContext& context,
                                              const CameraSet& cameras,
                                              StructureState* state) {
  ObservationChanges changes;
  PointTriangulationLimits point_limits;
  point_limits.threshold_px = noise.points.threshold_px;
  point_limits.noise_px = noise.points.stddev_px;
  point_limits.max_relative_depth_stddev = options.max_relative_depth_stddev;
  std::vector<PointTrackState> points(state->points.size());
  Status status = ParallelFor(context, {}, points.size(), [&](std::size_t n) {
    points[n] = UpdatePoint(cameras, point_limits, state->points[n]);
  });
  if (!status) return tl::unexpected<Error>(status.error());

  LineTriangulationLimits line_limits;
  line_limits.threshold_px = noise.lines.threshold_px;
  line_limits.noise_px = noise.lines.stddev_px;
  line_limits.max_relative_depth_stddev = options.max_relative_depth_stddev;
  line_limits.min_two_view_overlap = options.min_two_view_line_overlap;
  std::vector<char> solved(state->lines.size(), 0);
  for (const int n : SelectForSolve(cameras, *state, options).lines) {
    solved[n] = 1;
  }
  std::vector<LineTrackState> lines(state->lines.size());
  status = ParallelFor(context, {}, lines.size(), [&](std::size_t n) {
    lines[n] =
        UpdateLine(cameras, line_limits, solved[n] != 0, state->lines[n]);
  });
  if (!status) return tl::unexpected<Error>(status.error());

  for (std::size_t n = 0; n < points.size(); ++n) {
    changes.changed += CountChanges(state->points[n], points[n]);
    changes.total += points[n].candidates.size();
  }
  for (std::size_t n = 0; n < lines.size(); ++n) {
    if (solved[n]) changes.changed += CountChanges(state->lines[n], lines[n]);
    changes.total += lines[n].candidates.size();
  }
  state->points = std::move(points);
  state->lines = std::move(lines);

  for (PairState& pair : state->pairs) {
    const bool used =
        state->lines[pair.first].IsLandmark() &&
        state->lines[pair.second].IsLandmark() &&
        PairErrorPx(cameras, *state, pair, options.coplanar_residual) <=
            noise.coplanar.threshold_px;
    changes.changed += used != pair.used ? 1 : 0;
    pair.used = used;
  }
  changes.total += state->pairs.size();
  return changes;
}

}  // namespace lowlap::internal
