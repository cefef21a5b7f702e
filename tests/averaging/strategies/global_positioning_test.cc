#include "lowlap/averaging/strategies/internal/global_positioning.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "averaging/strategies/ray_problem.h"

namespace lowlap {
namespace {

TranslationSolution Solve(const TranslationProblem& problem,
                          const GlobalPositioningOptions& options = {},
                          std::uint64_t seed = 0) {
  RunContext context;
  context.seed = seed;
  const auto solution =
      GlobalPositioningAverager(options).Solve(problem, context);
  EXPECT_TRUE(solution);
  return *solution;
}

TEST(GlobalPositioning, ExactFromRandomStarts) {
  const RandomProblem made = MakeRayRing(20, 400, 5, true, 1);
  for (std::uint64_t seed = 0; seed < 10; ++seed) {
    const TranslationSolution solution = Solve(made.problem, {}, seed);
    EXPECT_EQ(solution.component, std::vector<int>(20, 0));
    EXPECT_LT(ErrorOfFirstPart(made, solution), 1e-6) << seed;
  }
}

TEST(GlobalPositioning, ExactFromAStart) {
  const RandomProblem made = MakeRayRing(20, 400, 5, true, 2);
  GlobalPositioningOptions options;
  Random random(3);
  for (const Vec3& center : made.centers) {
    options.start.push_back(center + RandomVector(&random, 0.5));
  }
  const TranslationSolution from_start = Solve(made.problem, options);
  EXPECT_LT(ErrorOfFirstPart(made, from_start), 1e-6);
  EXPECT_LT(from_start.num_iterations, Solve(made.problem).num_iterations);
}

TEST(GlobalPositioning, NoiseAndWrongRays) {
  RandomProblem made = MakeRayRing(20, 1200, 6, true, 4);
  Random random(5);
  for (TrackRays& track : made.problem.tracks) {
    for (RayObservation& seen : track.observations) {
      const double size = random.Uniform() < 0.05 ? 1.0 : 0.001;
      seen.ray_in_world =
          (seen.ray_in_world + RandomVector(&random, size)).normalized();
    }
  }
  EXPECT_LT(ErrorOfFirstPart(made, Solve(made.problem)), 0.01);
}

// Every fifth track sees another point in one of its views. The optimum of the
// published objective is moved by them; without wrong rays it is not.
TEST(GlobalPositioning, WrongTracksAreFoundAndDropped) {
  RandomProblem made = MakeRayRing(20, 1200, 6, true, 4);
  Random random(5);
  for (std::size_t k = 0; k < made.problem.tracks.size(); ++k) {
    auto& seen = made.problem.tracks[k].observations;
    for (RayObservation& each : seen) {
      each.ray_in_world =
          (each.ray_in_world + RandomVector(&random, 0.0005)).normalized();
    }
    if (k % 5 == 0) {
      seen[random.Index(6)].ray_in_world =
          RandomVector(&random, 1.0).normalized();
    }
  }
  GlobalPositioningOptions once;
  once.max_angle_deg = 180;
  const double error = ErrorOfFirstPart(made, Solve(made.problem));
  const double published = ErrorOfFirstPart(made, Solve(made.problem, once));
  EXPECT_LT(error, 0.002);
  EXPECT_GT(published, 3 * error);
  EXPECT_EQ(Solve(made.problem).num_components, 1);
}

TEST(GlobalPositioning, TracksOfTwoViewsFixNoScale) {
  const RandomProblem made = MakeRayRing(12, 240, 2, false, 6);
  EXPECT_EQ(Solve(made.problem).component, std::vector<int>(12, -1));
  GlobalPositioningOptions options;
  options.min_views_per_track = 2;
  const TranslationSolution pairs = Solve(made.problem, options);
  // Pairs that hold together only as such: each is a component.
  EXPECT_EQ(pairs.num_components, 11);
  EXPECT_EQ(std::count(pairs.component.begin(), pairs.component.end(), 0), 2);
}

TEST(GlobalPositioning, ShortTracksHelpWhereLongOnesFixTheScale) {
  RandomProblem made = MakeRayRing(12, 120, 3, false, 7);
  const RandomProblem more = MakeRayRing(12, 240, 2, false, 7);
  made.problem.tracks.insert(made.problem.tracks.end(),
                             more.problem.tracks.begin(),
                             more.problem.tracks.end());
  // Both were drawn with one seed: the same centres.
  ASSERT_EQ(made.centers, more.centers);
  GlobalPositioningOptions options;
  options.min_views_per_track = 2;
  const TranslationSolution solution = Solve(made.problem, options);
  EXPECT_EQ(solution.component, std::vector<int>(12, 0));
}

TEST(GlobalPositioning, PartsWithoutCommonPointsAreComponents) {
  RandomProblem made = MakeRayRing(16, 480, 4, false, 8);
  auto& tracks = made.problem.tracks;
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [](const TrackRays& track) {
                                return track.observations.front().view <= 9 &&
                                       track.observations.back().view > 9;
                              }),
               tracks.end());
  const TranslationSolution solution = Solve(made.problem);
  std::vector<int> expected(16, 1);
  std::fill(expected.begin(), expected.begin() + 10, 0);
  EXPECT_EQ(solution.component, expected);
  EXPECT_LT(ErrorOfFirstPart(made, solution), 1e-4);
}

TEST(GlobalPositioning, SameSeedSameResult) {
  const RandomProblem made = MakeRayRing(10, 100, 4, true, 9);
  EXPECT_EQ(Solve(made.problem, {}, 3).center_in_world,
            Solve(made.problem, {}, 3).center_in_world);
}

TEST(GlobalPositioning, NoTracksNoViews) {
  RandomProblem made = MakeRayRing(5, 50, 3, true, 10);
  made.problem.tracks.clear();
  EXPECT_EQ(Solve(made.problem).component, std::vector<int>(5, -1));
}

TEST(GlobalPositioning, RefusesWrongInput) {
  RandomProblem made = MakeRayRing(5, 50, 3, true, 11);
  const auto fails = [&](const GlobalPositioningOptions& options) {
    const auto solution =
        GlobalPositioningAverager(options).Solve(made.problem, RunContext());
    return !solution && solution.error().code == ErrorCode::kInvalidArgument;
  };
  GlobalPositioningOptions options;
  options.min_views_per_track = 1;
  EXPECT_TRUE(fails(options));
  options = {};
  options.start = {Vec3::Zero()};
  EXPECT_TRUE(fails(options));
  made.problem.tracks[0].observations[0].ray_in_world *= 2;
  EXPECT_TRUE(fails({}));
  made.problem.tracks[0].observations[0] = {77, Vec3::UnitZ()};
  EXPECT_TRUE(fails({}));
}

}  // namespace
}  // namespace lowlap
