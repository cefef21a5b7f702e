#include "lowlap/adjustment/internal/rounds/outlier_round.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "lowlap/adjustment/internal/rounds/pair_gap.h"
#include "lowlap/adjustment/internal/rounds/pair_selection.h"
#include "lowlap/adjustment/internal/rounds/problem_selection.h"
#include "lowlap/core/internal/parallel.h"
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

template <class Track>
void Abandon(LandmarkStatus status, Track* track) {
  for (auto& candidate : track->candidates) candidate.used = false;
  track->status = status;
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
      Abandon(LandmarkStatus::kInconsistent, &kept);
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
                          const LineTriangulationLimits& limits,
                          const LineTrackState& before) {
  LineTrackState kept = before;
  const bool all = MarkFitting(cameras, limits.threshold_px, &kept);
  if (kept.PoseCount(cameras) < 2) {
    Abandon(LandmarkStatus::kInconsistent, &kept);
  } else if (all) {
    return kept;
  }
  LineTrackState fresh = before;
  TriangulateLineTrack(cameras, limits, &fresh);
  return fresh.IsLandmark() && fresh.UsedCount() > kept.UsedCount() ? fresh
                                                                    : kept;
}

PointTriangulationLimits PointLimits(const AdjustmentOptions& options,
                                     const NoiseScale& noise) {
  return {noise.threshold_px, noise.stddev_px,
          options.max_relative_depth_stddev};
}

LineTriangulationLimits LineLimits(const AdjustmentOptions& options,
                                   const NoiseScale& noise) {
  return {noise.threshold_px, noise.stddev_px,
          options.max_relative_line_depth_stddev,
          options.min_two_view_line_overlap};
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

}  // namespace

Status FollowPoses(const AdjustmentOptions& options,
                   const NoiseScale& line_noise, const RunContext& context,
                   const CameraSet& cameras, StructureState* state) {
  // The errors of a kind that is off are known once it has followed: first at
  // any error, then at the threshold that these errors have.
  const NoiseScale any{1, std::numeric_limits<double>::infinity()};
  const NoiseBounds bounds = BoundsOf(options);
  if (!options.use_points) {
    std::vector<PointTrackState>& points = state->points;
    const std::vector<std::size_t> all = AllOf(points.size());
    Status status = TriangulatePoints(cameras, PointLimits(options, any),
                                      context, all, &points);
    if (!status) return status;
    const NoiseScale noise = EstimatePointNoise(cameras, points, bounds);
    status = TriangulatePoints(cameras, PointLimits(options, noise), context,
                               all, &points);
    if (!status) return status;
  }
  std::vector<LineTrackState>& lines = state->lines;
  if (!options.use_lines) {
    const std::vector<std::size_t> all = AllOf(lines.size());
    LOWLAP_RETURN_IF_ERROR(TriangulateLines(cameras, LineLimits(options, any),
                                            context, all, &lines));
    const NoiseScale noise = EstimateLineNoise(cameras, lines, bounds);
    return TriangulateLines(cameras, LineLimits(options, noise), context, all,
                            &lines);
  }
  const std::vector<char> solved = SolvedLines(options, cameras, *state);
  std::vector<std::size_t> unsolved;
  for (std::size_t n = 0; n < solved.size(); ++n) {
    if (!solved[n]) unsolved.push_back(n);
  }
  return TriangulateLines(cameras, LineLimits(options, line_noise), context,
                          unsolved, &lines);
}

NoiseLevels EstimateAllNoise(const CameraSet& cameras,
                             const StructureState& state,
                             const AdjustmentOptions& options) {
  NoiseBounds bounds = BoundsOf(options);
  NoiseLevels noise;
  noise.points = EstimatePointNoise(cameras, state.points, bounds);
  // Few lines of three views: they are taken to be about as good as points.
  bounds.fallback.stddev_px =
      std::max(bounds.fallback.stddev_px, noise.points.stddev_px);
  bounds.fallback.threshold_px =
      std::max(bounds.fallback.threshold_px, noise.points.threshold_px);
  noise.lines = EstimateLineNoise(cameras, state.lines, bounds);
  noise.coplanar = EstimatePairNoise(cameras, ComputePairGaps(cameras, state),
                                     noise.lines, bounds);
  return noise;
}

Result<ObservationChanges> UpdateObservations(const AdjustmentOptions& options,
                                              const NoiseLevels& noise,
                                              bool take_new_pairs,
                                              const RunContext& context,
                                              const CameraSet& cameras,
                                              StructureState* state) {
  ObservationChanges changes;
  Status status;
  if (options.use_points) {
    const PointTriangulationLimits limits = PointLimits(options, noise.points);
    std::vector<PointTrackState> points(state->points.size());
    status = ParallelFor(context, {}, points.size(), [&](std::size_t n) {
      points[n] = UpdatePoint(cameras, limits, state->points[n]);
    });
    if (!status) return tl::unexpected<Error>(status.error());
    for (std::size_t n = 0; n < points.size(); ++n) {
      changes.changed += CountChanges(state->points[n], points[n]);
      changes.total += points[n].candidates.size();
    }
    state->points = std::move(points);
  }
  if (!options.use_lines) return changes;

  const LineTriangulationLimits limits = LineLimits(options, noise.lines);
  const std::vector<char> solved = SolvedLines(options, cameras, *state);
  std::vector<LineTrackState> lines = state->lines;
  status = ParallelFor(context, {}, lines.size(), [&](std::size_t n) {
    if (solved[n]) {
      lines[n] = UpdateLine(cameras, limits, state->lines[n]);
    } else {
      TriangulateLineTrack(cameras, limits, &lines[n]);
    }
  });
  if (!status) return tl::unexpected<Error>(status.error());
  for (std::size_t n = 0; n < lines.size(); ++n) {
    if (solved[n] || lines[n].PoseCount(cameras) > 2) {
      changes.changed += CountChanges(state->lines[n], lines[n]);
      changes.total += lines[n].candidates.size();
    }
  }
  state->lines = std::move(lines);

  if (!options.use_coplanar) return changes;
  changes.changed += SelectPairs(options, cameras, noise.coplanar.threshold_px,
                                 take_new_pairs, state);
  changes.total += state->pairs.size();
  return changes;
}

}  // namespace lowlap
