#include "lowlap/averaging/scales/internal/refine_centers.h"

#include <gtest/gtest.h>

#include <cmath>

#include "averaging/random_problem.h"
#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

// Centres nearly on one plane, as of photographs from one height, where ratios
// say little about a step across the plane. Their errors are `understated`
// times what they state.
RandomProblem Courtyard(std::uint64_t seed, double understated) {
  constexpr std::size_t kViews = 16;
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  for (std::size_t n = 0; n < kViews; ++n) {
    for (std::size_t step = 1; step <= 4; ++step) {
      edges.push_back({n, (n + step) % kViews});
    }
  }
  RandomProblem made = MakeRandomProblem(kViews, edges, seed);
  Random random(seed + 100);
  for (std::size_t n = 0; n < kViews; ++n) {
    const double angle = 2 * 3.14159265358979 * static_cast<double>(n) / kViews;
    made.centers[n] = Vec3(10 * std::cos(angle), 7 * std::sin(angle), 0) +
                      RandomVector(&random, 0.05);
  }
  for (DirectionEdge& edge : made.problem.edges) {
    edge.stddev_rad = 5e-4;
    edge.direction_in_world =
        ((made.centers[edge.second] - made.centers[edge.first]).normalized() +
         RandomVector(&random, 2e-3))
            .normalized();
  }
  for (RatioMeasurement& ratio : made.problem.ratios) {
    ratio.stddev = 1e-3;
    ratio.log_ratio = made.TrueLogRatio(ratio.reference, ratio.target) +
                      random.Gaussian(understated * ratio.stddev);
  }
  return made;
}

TEST(RefineCenters, StatedDeviationsNeedNotHold) {
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    const RandomProblem made = Courtyard(seed, 6);
    const std::vector<bool> placed(made.centers.size(), true);
    Random random(seed + 200);
    std::vector<Vec3> centers = made.centers;
    for (Vec3& center : centers) center += RandomVector(&random, 0.05);
    ASSERT_TRUE(RefineCenters(made.problem, placed, &centers));
    // The scale of the start is kept; compare directions.
    for (const DirectionEdge& edge : made.problem.edges) {
      const Vec3 solved = centers[edge.second] - centers[edge.first];
      EXPECT_LT((solved.normalized() - edge.direction_in_world).norm(), 0.012)
          << seed;
    }
  }
}

TEST(RefineCenters, ExactMeasurementsAreReached) {
  const RandomProblem made = MakeRandomProblem(
      5, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}, {0, 2}, {1, 3}}, 3);
  std::vector<Vec3> centers = made.centers;
  Random random(4);
  for (Vec3& center : centers) center += RandomVector(&random, 0.01);
  ASSERT_TRUE(RefineCenters(made.problem, std::vector<bool>(5, true), &centers,
                            RunContext(), 200));
  for (const DirectionEdge& edge : made.problem.edges) {
    const Vec3 solved = centers[edge.second] - centers[edge.first];
    EXPECT_LT((solved.normalized() - edge.direction_in_world).norm(), 1e-4);
  }
}

TEST(RefineCenters, LeavesTheCentresWhenItIsStopped) {
  RandomProblem made = MakeRandomProblem(
      5,
      std::vector<std::pair<std::size_t, std::size_t>>{
          {0, 1}, {1, 2}, {2, 3}, {3, 4}, {0, 2}, {1, 3}, {2, 4}},
      3);
  std::vector<Vec3> centers = made.centers;
  Random random(1);
  for (Vec3& center : centers) center += RandomVector(&random, 0.1);
  const std::vector<Vec3> start = centers;
  RunContext context;
  int num_questions = 0;
  // The first step is made by then.
  context.progress = [&](const std::string&, std::size_t, std::size_t) {
    return ++num_questions < 2;
  };
  const Status stopped = RefineCenters(made.problem, std::vector<bool>(5, true),
                                       &centers, context);
  ASSERT_FALSE(stopped);
  EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
  EXPECT_EQ(centers, start);
}

}  // namespace
}  // namespace lowlap
