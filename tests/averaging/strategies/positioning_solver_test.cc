#include "lowlap/averaging/strategies/internal/positioning_solver.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "averaging/strategies/ray_problem.h"

namespace lowlap {
namespace {

// The true centres; points and scales from the first ray of every track.
PositioningState StateOf(const RandomProblem& made) {
  PositioningState state;
  state.centers = made.centers;
  for (const TrackRays& track : made.problem.tracks) {
    state.points.push_back(made.centers[track.observations[0].view] +
                           5 * track.observations[0].ray_in_world);
    state.scales.push_back(std::vector<double>(track.observations.size(), 0.2));
  }
  return state;
}

TEST(PositioningCost, IsTwiceHubersLossOfWhatMissesTheRay) {
  std::vector<TrackRays> tracks(2);
  tracks[0].observations = {{0, Vec3::UnitX()}, {1, Vec3::UnitY()}};
  tracks[1].observations = {{1, Vec3::UnitZ()}};
  PositioningState state;
  state.centers = {Vec3::Zero(), Vec3(0, 0, -1)};
  state.points = {Vec3(2, 0, 0), Vec3(0, 0, 1)};
  state.scales = {{0.5, 1.0}, {0.47}};
  // Residuals: 0; (0, 1, 0) - (2, 0, 1); (0, 0, 1 - 0.94).
  EXPECT_NEAR(PositioningCost(tracks, state, 0.1),
              (0.2 * std::sqrt(6.0) - 0.01) + 0.0036, 1e-14);
  EXPECT_NEAR(PositioningCost(tracks, state, 10), 6 + 0.0036, 1e-14);
}

TEST(PositioningSolver, ReachesExactRays) {
  const RandomProblem made = MakeRayRing(8, 160, 4, true, 17);
  PositioningState state = StateOf(made);
  Random random(18);
  for (Vec3& center : state.centers) center += RandomVector(&random, 0.3);
  const auto iterations =
      SolvePositions(made.problem.tracks, {}, RunContext(), &state);
  ASSERT_TRUE(iterations);
  EXPECT_GT(*iterations, 0);
  EXPECT_LT(
      GaugeFreeError(made.centers, state.centers, std::vector<bool>(8, true)),
      1e-6);
  for (std::size_t k = 0; k < made.problem.tracks.size(); ++k) {
    for (const double scale : state.scales[k]) EXPECT_GE(scale, 1e-6);
  }
}

TEST(PositioningSolver, HasNothingToDoWhereNoCostIsLeft) {
  RandomProblem made = MakeRayRing(6, 30, 3, true, 19);
  PositioningState state = StateOf(made);
  for (std::size_t k = 0; k < state.points.size(); ++k) {
    TrackRays& track = made.problem.tracks[k];
    for (std::size_t n = 0; n < track.observations.size(); ++n) {
      RayObservation& seen = track.observations[n];
      const Vec3 offset = state.points[k] - state.centers[seen.view];
      seen.ray_in_world = offset.normalized();
      state.scales[k][n] = 1 / offset.norm();
    }
  }
  const PositioningState before = state;
  const auto iterations =
      SolvePositions(made.problem.tracks, {}, RunContext(), &state);
  ASSERT_TRUE(iterations);
  EXPECT_EQ(*iterations, 0);
  EXPECT_EQ(state.centers, before.centers);
}

TEST(PositioningSolver, NeverEndsAboveItsStartAndKeepsItsIterations) {
  const RandomProblem made = MakeRayRing(8, 160, 4, true, 20);
  PositioningState state = StateOf(made);
  double last = PositioningCost(made.problem.tracks, state, 0.1);
  for (int step = 0; step < 6; ++step) {
    PositioningOptions options;
    options.max_iterations = 1;
    const auto iterations =
        SolvePositions(made.problem.tracks, options, RunContext(), &state);
    ASSERT_TRUE(iterations);
    EXPECT_LE(*iterations, 1);
    const double cost = PositioningCost(made.problem.tracks, state, 0.1);
    EXPECT_LE(cost, last);
    last = cost;
  }
}

TEST(PositioningSolver, TellsOfWhatIsNotFiniteAndStopsWhenAskedTo) {
  const RandomProblem made = MakeRayRing(6, 30, 3, true, 21);
  PositioningState state = StateOf(made);
  state.points[3].x() = HUGE_VAL;
  const auto failed =
      SolvePositions(made.problem.tracks, {}, RunContext(), &state);
  ASSERT_FALSE(failed);
  EXPECT_EQ(failed.error().code, ErrorCode::kNumerical);

  RunContext context;
  int num_questions = 0, stop_at = 0;
  context.progress = [&](const std::string&, std::size_t, std::size_t) {
    return ++num_questions != stop_at;
  };
  for (stop_at = 1; stop_at < 5; ++stop_at) {
    num_questions = 0;
    state = StateOf(made);
    const auto stopped =
        SolvePositions(made.problem.tracks, {}, context, &state);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
    EXPECT_EQ(num_questions, stop_at);
  }
}

// ray - s (X - C).
struct RayError {
  template <typename T>
  bool operator()(const T* center, const T* point, const T* scale,
                  T* residual) const {
    for (int axis = 0; axis < 3; ++axis) {
      residual[axis] = ray(axis) - *scale * (point[axis] - center[axis]);
    }
    return true;
  }
  Vec3 ray;
};

TEST(PositioningSolver, MeetsCeres) {
  RandomProblem made = MakeRayRing(6, 60, 3, true, 15);
  Random random(16);
  for (TrackRays& track : made.problem.tracks) {
    for (RayObservation& seen : track.observations) {
      const double size = random.Uniform() < 0.1 ? 0.5 : 0.02;
      seen.ray_in_world =
          (seen.ray_in_world + RandomVector(&random, size)).normalized();
    }
  }
  const auto& tracks = made.problem.tracks;
  PositioningState state = StateOf(made);
  PositioningState theirs = state;
  PositioningOptions options;
  options.max_iterations = 2000;
  ASSERT_TRUE(SolvePositions(tracks, options, RunContext(), &state));

  ceres::Problem problem;
  auto* loss = new ceres::HuberLoss(options.huber_reach);
  for (std::size_t k = 0; k < tracks.size(); ++k) {
    for (std::size_t n = 0; n < tracks[k].observations.size(); ++n) {
      const RayObservation& seen = tracks[k].observations[n];
      problem.AddResidualBlock(
          new ceres::AutoDiffCostFunction<RayError, 3, 3, 3, 1>(
              new RayError{seen.ray_in_world}),
          loss, theirs.centers[seen.view].data(), theirs.points[k].data(),
          &theirs.scales[k][n]);
      problem.SetParameterLowerBound(&theirs.scales[k][n], 0, 1e-6);
    }
  }
  ceres::Solver::Options solver;
  solver.linear_solver_type = ceres::SPARSE_NORMAL_CHOLESKY;
  solver.max_num_iterations = 2000;
  solver.function_tolerance = 1e-12;
  solver.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(solver, &problem, &summary);
  const double cost = PositioningCost(tracks, theirs, options.huber_reach);
  EXPECT_NEAR(PositioningCost(tracks, state, options.huber_reach), cost,
              0.01 * cost);
}

TEST(PositioningSolver, StopsAtAMinimum) {
  RandomProblem made = MakeRayRing(6, 60, 3, true, 12);
  Random random(13);
  for (TrackRays& track : made.problem.tracks) {
    for (RayObservation& seen : track.observations) {
      seen.ray_in_world =
          (seen.ray_in_world + RandomVector(&random, 0.05)).normalized();
    }
  }
  const auto& tracks = made.problem.tracks;
  PositioningState state = StateOf(made);
  PositioningOptions options;
  options.max_iterations = 2000;
  ASSERT_TRUE(SolvePositions(tracks, options, RunContext(), &state));
  const double best = PositioningCost(tracks, state, options.huber_reach);
  EXPECT_GT(best, 1e-3);
  for (int trial = 0; trial < 2000; ++trial) {
    PositioningState other = state;
    const double size = std::pow(10.0, random.Uniform(-4, -1));
    for (Vec3& center : other.centers) center += RandomVector(&random, size);
    for (Vec3& point : other.points) point += RandomVector(&random, size);
    EXPECT_GE(PositioningCost(tracks, other, options.huber_reach),
              best * (1 - 1e-6));
  }
}

}  // namespace
}  // namespace lowlap
