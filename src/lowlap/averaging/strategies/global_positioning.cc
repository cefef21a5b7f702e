#include "lowlap/averaging/strategies/internal/global_positioning.h"

#include <Eigen/LU>
#include <cmath>
#include <numeric>
#include <utility>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/strategies/internal/placed_parts.h"
#include "lowlap/averaging/strategies/internal/positioning_solver.h"
#include "lowlap/averaging/strategies/internal/track_groups.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

/// Views whose tracks fix one scale, and what is known of them.
struct Part {
  std::vector<std::size_t> views;  // indices into the problem's views
  std::vector<TrackRays> tracks;   // of these views, by their index in `views`
  PositioningState state;
};

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

constexpr std::size_t kOutside = static_cast<std::size_t>(-1);

/// Per view, its index in `views`, or kOutside.
std::vector<std::size_t> IndicesOf(const std::vector<std::size_t>& views,
                                   std::size_t num_views) {
  std::vector<std::size_t> index(num_views, kOutside);
  for (std::size_t n = 0; n < views.size(); ++n) index[views[n]] = n;
  return index;
}

/// A group of views with a start.
Part StartPart(const TranslationProblem& problem,
               const GlobalPositioningOptions& options,
               std::vector<std::size_t> views, std::uint64_t seed) {
  Part part;
  const auto index = IndicesOf(views, problem.views.size());
  for (const TrackRays& track : problem.tracks) {
    TrackRays kept;
    for (const RayObservation& seen : track.observations) {
      if (index[seen.view] == kOutside) continue;
      kept.observations.push_back({index[seen.view], seen.ray_in_world});
    }
    if (kept.observations.size() >= options.min_views_per_track) {
      part.tracks.push_back(std::move(kept));
    }
  }
  part.state = StartState(options, views, part.tracks, seed);
  part.views = std::move(views);
  return part;
}

/// What `keep(track, observation)` accepts of some views of a part.
template <class Keep>
Part Restrict(const Part& part, const std::vector<std::size_t>& views,
              std::size_t min_views_per_track, const Keep& keep) {
  Part kept;
  for (const std::size_t view : views) {
    kept.views.push_back(part.views[view]);
    kept.state.centers.push_back(part.state.centers[view]);
  }
  const auto index = IndicesOf(views, part.views.size());
  for (std::size_t k = 0; k < part.tracks.size(); ++k) {
    TrackRays track;
    std::vector<double> scales;
    for (std::size_t n = 0; n < part.tracks[k].observations.size(); ++n) {
      const RayObservation& seen = part.tracks[k].observations[n];
      if (index[seen.view] == kOutside || !keep(k, n)) continue;
      track.observations.push_back({index[seen.view], seen.ray_in_world});
      scales.push_back(part.state.scales[k][n]);
    }
    if (track.observations.size() < min_views_per_track) continue;
    kept.tracks.push_back(std::move(track));
    kept.state.points.push_back(part.state.points[k]);
    kept.state.scales.push_back(std::move(scales));
  }
  return kept;
}

/// The part without the rays that miss their points by more than `max_angle`.
Part WithoutWrongRays(const Part& part,
                      const GlobalPositioningOptions& options) {
  const double least_cosine = std::cos(options.max_angle_deg * kPi / 180);
  std::vector<std::size_t> views(part.views.size());
  std::iota(views.begin(), views.end(), std::size_t{0});
  return Restrict(part, views, options.min_views_per_track,
                  [&](std::size_t k, std::size_t n) {
                    const RayObservation& seen = part.tracks[k].observations[n];
                    const Vec3 offset =
                        part.state.points[k] - part.state.centers[seen.view];
                    return seen.ray_in_world.dot(offset) >=
                           least_cosine * offset.norm();
                  });
}

/// Solves a group, and what hangs together of it once more without wrong rays.
Result<std::vector<Part>> SolveGroup(Part group,
                                     const GlobalPositioningOptions& options,
                                     const RunContext& context,
                                     int* num_iterations) {
  const PositioningOptions solver = {options.huber_reach,
                                     options.max_iterations};
  // Starting a solution takes a while as well.
  const auto ask = [&] { return AskToGoOn(context, 0, solver.max_iterations); };
  const auto solve = [&](Part* part) -> Status {
    LOWLAP_RETURN_IF_ERROR(ask());
    LOWLAP_ASSIGN_OR_RETURN(
        const auto iterations,
        SolvePositions(part->tracks, solver, context, &part->state));
    *num_iterations += iterations;
    return {};
  };
  LOWLAP_RETURN_IF_ERROR(solve(&group));
  std::vector<Part> parts;
  if (options.max_angle_deg >= 180) {
    parts.push_back(std::move(group));
    return parts;
  }
  LOWLAP_RETURN_IF_ERROR(ask());
  const Part cleaned = WithoutWrongRays(group, options);
  LOWLAP_RETURN_IF_ERROR(ask());
  for (const std::vector<std::size_t>& views : GroupViewsByTracks(
           cleaned.views.size(), cleaned.tracks, options.min_views_per_track,
           options.min_shared_points)) {
    LOWLAP_RETURN_IF_ERROR(ask());
    Part part = Restrict(cleaned, views, options.min_views_per_track,
                         [](std::size_t, std::size_t) { return true; });
    LOWLAP_RETURN_IF_ERROR(solve(&part));
    parts.push_back(std::move(part));
  }
  return parts;
}

}  // namespace

Status GlobalPositioningOptions::Validate() const {
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
  if (!(max_angle_deg > 0))
    return invalid("the largest angle must be positive");
  for (const Vec3& center : start) {
    if (!center.allFinite()) return invalid("the start is not finite");
  }
  return {};
}

Result<TranslationSolution> GlobalPositioningAverager::Solve(
    const TranslationProblem& problem, const RunContext& context) const {
  LOWLAP_RETURN_IF_ERROR(ValidateProblem(problem));
  LOWLAP_RETURN_IF_ERROR(options_.Validate());
  if (!options_.start.empty() &&
      options_.start.size() != problem.views.size()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "global positioning: the start needs one centre per view");
  }
  LOWLAP_RETURN_IF_ERROR(AskToGoOn(context, 0, 1));
  PlacedParts placed(problem.views.size());
  int num_iterations = 0;
  for (std::vector<std::size_t>& views : GroupViewsByTracks(
           problem.views.size(), problem.tracks, options_.min_views_per_track,
           options_.min_shared_points)) {
    if (placed.HasAll(views)) continue;
    LOWLAP_RETURN_IF_ERROR(AskToGoOn(context, 0, options_.max_iterations));
    LOWLAP_ASSIGN_OR_RETURN(
        auto solved,
        SolveGroup(StartPart(problem, options_, std::move(views), context.seed),
                   options_, context, &num_iterations));
    for (Part& part : solved) {
      placed.Add(std::move(part.views), std::move(part.state.centers));
    }
  }
  TranslationSolution solution = std::move(placed).MakeSolution();
  solution.num_iterations = num_iterations;
  return solution;
}

}  // namespace lowlap
