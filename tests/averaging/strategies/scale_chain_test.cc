#include "lowlap/averaging/strategies/internal/scale_chain.h"

#include <gtest/gtest.h>

#include <cmath>

#include "averaging/random_problem.h"

namespace lowlap {
namespace {

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

TranslationSolution Solve(const TranslationProblem& problem) {
  const auto solution = ScaleChainAverager().Solve(problem, RunContext());
  EXPECT_TRUE(solution);
  return *solution;
}

// Views 0 to 3 with edges along x, y and z, the last one against the chain.
RandomProblem Corner() {
  RandomProblem made = MakeRandomProblem(4, Edges{{0, 1}, {1, 2}, {3, 2}}, 1,
                                         /*with_ratios=*/false);
  made.centers = {{0, 0, 0}, {1, 0, 0}, {1, 2, 0}, {1, 2, 6}};
  made.problem.edges[0].direction_in_world = Vec3::UnitX();
  made.problem.edges[1].direction_in_world = Vec3::UnitY();
  made.problem.edges[2].direction_in_world = -Vec3::UnitZ();
  made.AddRatio(0, 1);
  made.AddRatio(2, 1);
  return made;
}

TEST(ScaleChain, LaysEdgesEndToEndFromTheFirst) {
  const RandomProblem made = Corner();
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.component, std::vector<int>(4, 0));
  EXPECT_EQ(solution.num_components, 1);
  // The first view is the origin, the first edge has length 1.
  for (std::size_t n = 0; n < 4; ++n) {
    EXPECT_LT((solution.center_in_world[n] - made.centers[n]).norm(), 1e-13);
  }
}

// Of two ratios that disagree the more meaningful one is taken, not a mean.
TEST(ScaleChain, MultipliesTheMostMeaningfulRatiosOnly) {
  RandomProblem made = Corner();
  made.AddRatio(0, 1, /*error=*/0.4);
  made.problem.ratios[2].log10_nfa = -10;
  EXPECT_NEAR(Solve(made.problem).center_in_world[2].y(), 2, 1e-13);
  made.problem.ratios[2].log10_nfa = -100;
  EXPECT_NEAR(Solve(made.problem).center_in_world[2].y(), 2 * std::exp(0.4),
              1e-13);
}

// A triangle whose closing edge is wrong: only two of its edges are used.
TEST(ScaleChain, FollowsTheEdgesOfLeastDeviation) {
  RandomProblem made = MakeRandomProblem(3, Edges{{0, 1}, {1, 2}, {0, 2}}, 2);
  for (std::size_t wrong = 0; wrong < 3; ++wrong) {
    TranslationProblem problem = made.problem;
    problem.edges[wrong].direction_in_world = Vec3::UnitX();
    for (DirectionEdge& edge : problem.edges) edge.stddev_rad = 0.01;
    problem.edges[wrong].stddev_rad = 0.02;
    EXPECT_LT(GaugeFreeError(made.centers, Solve(problem).center_in_world,
                             std::vector<bool>(3, true)),
              1e-12)
        << wrong;
  }
}

TEST(ScaleChain, WithoutARatioAcrossACameraThereAreTwoComponents) {
  // 0-1-2 and 2-3-4-5; view 2 goes with the larger group.
  RandomProblem made =
      MakeRandomProblem(7, Edges{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}, 3,
                        /*with_ratios=*/false);
  made.AddRatio(0, 1);
  made.AddRatio(2, 3);
  made.AddRatio(3, 4);
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.component, (std::vector<int>{1, 1, 0, 0, 0, 0, -1}));
  EXPECT_EQ(solution.num_components, 2);
  EXPECT_LT(GaugeFreeError(made.centers, solution.center_in_world,
                           {false, false, true, true, true, true, false}),
            1e-12);
}

TEST(ScaleChain, RefusesInvalidProblemsAndStopsWhenAskedTo) {
  RandomProblem made = Corner();
  RunContext context;
  context.progress = [](const std::string&, std::size_t, std::size_t) {
    return false;
  };
  auto solution = ScaleChainAverager().Solve(made.problem, context);
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.error().code, ErrorCode::kCancelled);
  made.problem.edges[0].stddev_rad = 0;
  solution = ScaleChainAverager().Solve(made.problem, RunContext());
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.error().code, ErrorCode::kInvalidArgument);
  EXPECT_EQ(Solve(TranslationProblem()).num_components, 0);
}

}  // namespace
}  // namespace lowlap
