#include "lowlap/averaging/strategies/internal/graph_scales.h"

#include <gtest/gtest.h>

#include "averaging/random_problem.h"
#include "lowlap/averaging/averager_registry.h"

namespace lowlap {
namespace {

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

std::vector<bool> PlacedInFirst(const TranslationSolution& solution) {
  std::vector<bool> placed;
  for (const int component : solution.component) {
    placed.push_back(component == 0);
  }
  return placed;
}

// Strategies that use ratios, so that they place what directions cannot.
class RatioStrategy : public ::testing::TestWithParam<std::string> {
 protected:
  TranslationSolution Solve(const TranslationProblem& problem) {
    const auto averager = AveragerRegistry::WithBuiltIns().Make(GetParam());
    auto solution = (*averager)->Solve(problem, RunContext());
    EXPECT_TRUE(solution);
    return *solution;
  }
};

TEST_P(RatioStrategy, ChainWithoutTrifocalFeaturesIsExact) {
  Edges edges;
  for (std::size_t n = 0; n < 30; ++n) edges.push_back({n, n + 1});
  const RandomProblem made = MakeRandomProblem(31, edges, 1);
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.num_components, 1);
  EXPECT_LT(GaugeFreeError(made.centers, solution.center_in_world,
                           PlacedInFirst(solution)),
            1e-9);
}

TEST_P(RatioStrategy, DenseGraphIsExact) {
  Edges edges;
  for (std::size_t a = 0; a < 9; ++a) {
    for (std::size_t b = a + 1; b < 9; ++b) edges.push_back({a, b});
  }
  const RandomProblem made = MakeRandomProblem(9, edges, 2);
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.num_components, 1);
  EXPECT_LT(GaugeFreeError(made.centers, solution.center_in_world,
                           PlacedInFirst(solution)),
            1e-9);
}

TEST_P(RatioStrategy, AFloatingPartIsAComponentOfItsOwn) {
  // Two chains that meet in view 3 without a ratio across it.
  RandomProblem made =
      MakeRandomProblem(6, Edges{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 5}}, 3,
                        /*with_ratios=*/false);
  made.AddRatio(0, 1);
  made.AddRatio(1, 2);
  made.AddRatio(3, 4);
  const TranslationSolution solution = Solve(made.problem);
  EXPECT_EQ(solution.num_components, 2);
  EXPECT_EQ(solution.component, (std::vector<int>{0, 0, 0, 0, 1, 1}));
}

INSTANTIATE_TEST_SUITE_P(All, RatioStrategy,
                         ::testing::Values("graph", "chain"));
TEST(GraphScales, DirectionsAloneFixATriangleWithoutRatios) {
  // Edges {0, 1} and {1, 2} have a ratio; view 3 hangs on directions only.
  RandomProblem made =
      MakeRandomProblem(4, Edges{{0, 1}, {1, 2}, {0, 3}, {2, 3}, {1, 3}}, 5,
                        /*with_ratios=*/false);
  made.AddRatio(0, 1);
  const auto solution = GraphScalesAverager().Solve(made.problem, RunContext());
  ASSERT_TRUE(solution);
  EXPECT_EQ(solution->num_components, 1);
  EXPECT_LT(GaugeFreeError(made.centers, solution->center_in_world,
                           PlacedInFirst(*solution)),
            1e-9);
}

TEST(GraphScales, GroupsThatShareTwoViewsShareAScale) {
  // {0,1},{1,2},{2,3} and {3,4},{4,0}: no ratio between the groups, but views
  // 0 and 3 belong to both.
  RandomProblem made =
      MakeRandomProblem(5, Edges{{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}}, 6,
                        /*with_ratios=*/false);
  made.AddRatio(0, 1);
  made.AddRatio(1, 2);
  made.AddRatio(3, 4);
  const auto solution = GraphScalesAverager().Solve(made.problem, RunContext());
  ASSERT_TRUE(solution);
  EXPECT_EQ(solution->num_components, 1);
  EXPECT_LT(GaugeFreeError(made.centers, solution->center_in_world,
                           PlacedInFirst(*solution)),
            1e-9);
}

// A chain of five views with ratios, and in its last view, without a ratio
// across it, a mesh of 20 that directions alone fix.
TEST(GraphScales, APartThatGrowsLargerThanTheFirstIsTheFirstComponent) {
  constexpr std::size_t kChain = 5, kMesh = 20, kJoint = kChain - 1;
  Edges edges;
  for (std::size_t n = 0; n < kJoint; ++n) edges.push_back({n, n + 1});
  for (std::size_t n = 0; n < kMesh; ++n) {
    for (std::size_t step = 1; step <= 3; ++step) {
      edges.push_back({kJoint + n, kJoint + (n + step) % kMesh});
    }
  }
  RandomProblem made = MakeRandomProblem(kJoint + kMesh, edges, 9,
                                         /*with_ratios=*/false);
  for (std::size_t e = 0; e + 1 < kJoint; ++e) made.AddRatio(e, e + 1);
  const auto solution = GraphScalesAverager().Solve(made.problem, RunContext());
  ASSERT_TRUE(solution);
  EXPECT_EQ(solution->num_components, 2);
  std::vector<int> expected(kJoint, 1);
  expected.resize(kJoint + kMesh, 0);
  EXPECT_EQ(solution->component, expected);
  EXPECT_LT(GaugeFreeError(made.centers, solution->center_in_world,
                           PlacedInFirst(*solution)),
            1e-9);
}

TEST(GraphScales, ToleratesWrongEdgesAndRatios) {
  Edges edges;
  constexpr std::size_t kViews = 20;
  for (std::size_t n = 0; n < kViews; ++n) {
    for (std::size_t step = 1; step <= 4; ++step) {
      edges.push_back({n, (n + step) % kViews});
    }
  }
  RandomProblem made = MakeRandomProblem(kViews, edges, 7);
  Random random(8);
  for (DirectionEdge& edge : made.problem.edges) {
    const double size = random.Uniform() < 0.05 ? 1.0 : 0.002;
    edge.stddev_rad = 0.002;
    edge.direction_in_world =
        (edge.direction_in_world + RandomVector(&random, size)).normalized();
  }
  for (RatioMeasurement& ratio : made.problem.ratios) {
    const bool wrong = random.Uniform() < 0.15;
    ratio.log_ratio += wrong ? random.Uniform(-2, 2) : random.Gaussian(0.01);
    if (wrong) ratio.log10_nfa = -2;
  }
  const auto solution = GraphScalesAverager().Solve(made.problem, RunContext());
  ASSERT_TRUE(solution);
  EXPECT_EQ(solution->num_components, 1);
  EXPECT_LT(GaugeFreeError(made.centers, solution->center_in_world,
                           PlacedInFirst(*solution)),
            0.01);
}

TEST(GraphScales, RefusesOptionsWithoutIterations) {
  GraphScalesOptions options;
  options.max_scale_iterations = 0;
  const RandomProblem made = MakeRandomProblem(3, Edges{{0, 1}, {1, 2}}, 1);
  const auto solution =
      GraphScalesAverager(options).Solve(made.problem, RunContext());
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.error().code, ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace lowlap
