#include "lowlap/averaging/global_positioning.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lowlap/averaging/internal/positioning_solver.h"
#include "lowlap/averaging/internal/track_groups.h"
#include "lowlap/core/random.h"

namespace lowlap {
namespace {

/// The tracks of one group of views, with the views' indices in the group.
std::vector<TrackRays> TracksOfGroup(const TranslationProblem& problem,
                                     const std::vector<std::size_t>& views,
                                     std::size_t min_views) {
  constexpr std::size_t kOutside = static_cast<std::size_t>(-1);
  std::vector<std::size_t> index(problem.views.size(), kOutside);
  for (std::size_t n = 0; n < views.size(); ++n) index[views[n]] = n;
  std::vector<TrackRays> tracks;
  for (const TrackRays& track : problem.tracks) {
    TrackRays kept;
    for (const RayObservation& seen : track.observations) {
      if (index[seen.view] == kOutside) continue;
      kept.observations.push_back({index[seen.view], seen.ray_in_world});
    }
    if (kept.observations.size() >= min_views) tracks.push_back(kept);
  }
  return tracks;
}

Vec3 RandomPosition(Random* random) {
  Vec3 position;
  for (int n = 0; n < 3; ++n) position(n) = random->Uniform(-1, 1);
  return position;
}

/// The point nearest to all rays; `fallback` where they are parallel.
Vec3 NearestPoint(const TrackRays& track, const std::vector<Vec3>& centers,
                  const Vec3& fallback) {
  Mat3 normal = Mat3::Zero();
  Vec3 rhs = Vec3::Zero();
  for (const RayObservation& seen : track.observations) {
    const Mat3 across =
        Mat3::Identity() - seen.ray_in_world * seen.ray_in_world.transpose();
    normal += across;
    rhs += across * centers[seen.view];
  }
  const Vec3 point = normal.inverse() * rhs;
  return normal.determinant() > 1e-9 && point.allFinite() ? point : fallback;
}

PositioningState StartState(const GlobalPositioningOptions& options,
                            const std::vector<std::size_t>& views,
                            const std::vector<TrackRays>& tracks,
                            std::uint64_t seed) {
  PositioningState state;
  Random random(seed);
  for (const std::size_t view : views) {
    state.centers.push_back(options.start.empty() ? RandomPosition(&random)
                                                  : options.start[view]);
  }
  for (const TrackRays& track : tracks) {
    const Vec3 drawn = RandomPosition(&random);
    state.points.push_back(options.start.empty()
                               ? drawn
                               : NearestPoint(track, state.centers, drawn));
    std::vector<double> scales;
    for (const RayObservation& seen : track.observations) {
      const Vec3 offset = state.points.back() - state.centers[seen.view];
      const double square = offset.squaredNorm();
      const double best =
          square > 0 ? seen.ray_in_world.dot(offset) / square : 0.0;
      scales.push_back(options.start.empty() || !(best > 0) ? 1.0 : best);
    }
    state.scales.push_back(std::move(scales));
  }
  return state;
}

}  // namespace

Status GlobalPositioningOptions::Validate(std::size_t num_views) const {
  const auto invalid = [](const std::string& message) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "global positioning: " + message);
  };
  if (min_views_per_track < 2) return invalid("a track has at least two views");
  if (min_shared_points < 2) {
    return invalid("fewer than two shared points fix no scale");
  }
  if (!(huber_reach > 0) || max_iterations < 1) {
    return invalid("the reach and the number of iterations must be positive");
  }
  if (!start.empty() && start.size() != num_views) {
    return invalid("the start needs one centre per view");
  }
  for (const Vec3& center : start) {
    if (!center.allFinite()) return invalid("the start is not finite");
  }
  return {};
}

Result<TranslationSolution> GlobalPositioningAverager::Solve(
    const TranslationProblem& problem, const RunContext& context) const {
  Status status = ValidateProblem(problem);
  if (status) status = options_.Validate(problem.views.size());
  if (!status) return tl::unexpected<Error>(status.error());
  TranslationSolution solution;
  solution.component.assign(problem.views.size(), -1);
  solution.center_in_world.assign(problem.views.size(), Vec3::Zero());
  for (const std::vector<std::size_t>& views : GroupViewsByTracks(
           problem.views.size(), problem.tracks, options_.min_views_per_track,
           options_.min_shared_points)) {
    const bool adds_views = std::any_of(
        views.begin(), views.end(),
        [&](std::size_t view) { return solution.component[view] < 0; });
    if (!adds_views) continue;
    const std::vector<TrackRays> tracks =
        TracksOfGroup(problem, views, options_.min_views_per_track);
    PositioningState state = StartState(options_, views, tracks, context.seed);
    const auto iterations =
        SolvePositions(tracks, {options_.huber_reach, options_.max_iterations},
                       context, &state);
    if (!iterations) return tl::unexpected<Error>(iterations.error());
    solution.num_iterations += *iterations;
    for (std::size_t n = 0; n < views.size(); ++n) {
      if (solution.component[views[n]] >= 0) continue;
      solution.component[views[n]] = solution.num_components;
      solution.center_in_world[views[n]] = state.centers[n];
    }
    ++solution.num_components;
  }
  return solution;
}

}  // namespace lowlap
