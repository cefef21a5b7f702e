#include "averaging/big_graph.h"

#include <gtest/gtest.h>

#include <string>

#include "lowlap/averaging/strategies/internal/graph_scales.h"

namespace lowlap {
namespace {

class BigGraphs : public ::testing::TestWithParam<GraphShape> {};

// 5,000 views, 20,000 edges, 60,000 ratios, a fifth of them wrong by a factor
// of up to seven and as sure of themselves as the others.
TEST_P(BigGraphs, WrongRatiosHardlyCostAccuracy) {
  BigGraphOptions options;
  options.shape = GetParam();
  const BigGraph graph = MakeBigGraph(options);
  ASSERT_EQ(graph.made.problem.edges.size(), 20'000u);
  ASSERT_EQ(graph.made.problem.ratios.size(), 60'000u);
  ASSERT_NEAR(static_cast<double>(graph.oracle.ratios.size()), 48'000, 600);

  const GraphScalesAverager averager;
  const auto solution = averager.Solve(graph.made.problem, RunContext());
  ASSERT_TRUE(solution);
  EXPECT_EQ(solution->num_components, 1);

  const auto oracle = averager.Solve(graph.oracle, RunContext());
  ASSERT_TRUE(oracle);
  const double error = MedianCenterError(graph.made, *solution);
  const double best = MedianCenterError(graph.made, *oracle);
  RecordProperty("error", std::to_string(error));
  RecordProperty("oracle_error", std::to_string(best));
  EXPECT_LE(error, 2 * best);
}

INSTANTIATE_TEST_SUITE_P(Shapes, BigGraphs,
                         ::testing::Values(GraphShape::kStreet,
                                           GraphShape::kTown,
                                           GraphShape::kRandom));

// Views that directions place one after the other, and a street where every
// pair is a part of its own.
TEST(BigGraph, WithoutRatiosIsPlacedAsFarAsDirectionsGo) {
  for (const bool is_town : {true, false}) {
    BigGraphOptions options;
    options.shape = is_town ? GraphShape::kTown : GraphShape::kStreet;
    options.num_views = 2000;
    options.num_edges = is_town ? 10'000 : 1999;
    options.num_ratios = 0;
    options.direction_stddev_rad = 0.001;
    const BigGraph graph = MakeBigGraph(options);
    const auto solution =
        GraphScalesAverager().Solve(graph.made.problem, RunContext());
    ASSERT_TRUE(solution);
    EXPECT_EQ(solution->NumPlaced(), is_town ? 2000 : 2);
  }
}

}  // namespace
}  // namespace lowlap
