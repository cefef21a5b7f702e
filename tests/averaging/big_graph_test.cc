#include "averaging/big_graph.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <ctime>

#include "lowlap/averaging/strategies/internal/graph_scales.h"

namespace lowlap {
namespace {

double ProcessorSeconds() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

double PeakMegabytes() {
  rusage usage = {};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024;
}

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
  const double start = ProcessorSeconds();
  const auto solution = averager.Solve(graph.made.problem, RunContext());
  const double seconds = ProcessorSeconds() - start;
  ASSERT_TRUE(solution);
  EXPECT_LE(seconds, 10);
  EXPECT_LE(PeakMegabytes(), 1024);
  EXPECT_EQ(solution->num_components, 1);

  const auto oracle = averager.Solve(graph.oracle, RunContext());
  ASSERT_TRUE(oracle);
  const double error = MedianCenterError(graph.made, *solution);
  const double best = MedianCenterError(graph.made, *oracle);
  RecordProperty("seconds", std::to_string(seconds));
  RecordProperty("error", std::to_string(error));
  RecordProperty("oracle_error", std::to_string(best));
  EXPECT_LE(error, 2 * best);
}

INSTANTIATE_TEST_SUITE_P(Shapes, BigGraphs,
                         ::testing::Values(GraphShape::kStreet,
                                           GraphShape::kTown,
                                           GraphShape::kRandom));

}  // namespace
}  // namespace lowlap
