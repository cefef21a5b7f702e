#include "lowlap/averaging/internal/difference_solver.h"

#include <gtest/gtest.h>

#include <array>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/core/internal/union_find.h"

namespace lowlap {
namespace {

TEST(SolveDifferences, TreeIsReproducedExactly) {
  const std::vector<DifferenceEdge> edges = {{0, 1}, {2, 1}, {1, 3}};
  Eigen::MatrixXd measurements(3, 2);
  measurements << 1, 2, 3, 4, 5, 6;
  const auto x =
      SolveDifferences(4, edges, Eigen::Vector3d(1, 5, 0.2), measurements);
  ASSERT_TRUE(x);
  EXPECT_TRUE(x->row(0).isZero());
  EXPECT_TRUE(x->row(1).isApprox(Eigen::RowVector2d(1, 2)));
  EXPECT_TRUE(x->row(2).isApprox(Eigen::RowVector2d(-2, -2)));
  EXPECT_TRUE(x->row(3).isApprox(Eigen::RowVector2d(6, 8)));
}

TEST(SolveDifferences, EveryComponentHasItsOwnGauge) {
  const std::vector<DifferenceEdge> edges = {{0, 2}, {1, 3}, {2, 3}};
  Eigen::MatrixXd measurements(3, 1);
  measurements << 1, 7, 100;
  // The third edge has no weight, so it joins nothing.
  const auto x =
      SolveDifferences(5, edges, Eigen::Vector3d(1, 1, 0), measurements);
  ASSERT_TRUE(x);
  EXPECT_EQ((*x)(0, 0), 0);
  EXPECT_EQ((*x)(1, 0), 0);
  EXPECT_DOUBLE_EQ((*x)(2, 0), 1);
  EXPECT_DOUBLE_EQ((*x)(3, 0), 7);
  EXPECT_EQ((*x)(4, 0), 0);
}

TEST(SolveDifferences, LoopIsTheWeightedLeastSquares) {
  // A loop of three with closing error 3 and weights 1, 1, 2: the error is
  // shared as 1/w, i.e. 1.2, 1.2, 0.6.
  const std::vector<DifferenceEdge> edges = {{0, 1}, {1, 2}, {2, 0}};
  Eigen::MatrixXd measurements(3, 1);
  measurements << 1, 1, 1;
  const auto x =
      SolveDifferences(3, edges, Eigen::Vector3d(1, 1, 2), measurements);
  ASSERT_TRUE(x);
  EXPECT_NEAR((*x)(1, 0), 1 - 1.2, 1e-12);
  EXPECT_NEAR((*x)(2, 0), 2 - 2.4, 1e-12);
}

TEST(MinimumSpanningForest, PrefersLowCostsAndWalksFromTheRoot) {
  const std::vector<DifferenceEdge> edges = {{0, 1}, {1, 2}, {0, 2}, {3, 4}};
  const auto walk = MinimumSpanningForest(5, edges, {5, 1, 2, 9});
  std::vector<std::array<std::size_t, 3>> steps;
  for (const ForestStep& step : walk) {
    steps.push_back({step.edge, step.from, step.to});
  }
  EXPECT_EQ(steps, (std::vector<std::array<std::size_t, 3>>{
                       {2, 0, 2}, {1, 2, 1}, {3, 3, 4}}));
}

TEST(UnionFind, LabelsFollowFirstAppearance) {
  UnionFind sets(5);
  EXPECT_TRUE(sets.Union(4, 1));
  EXPECT_TRUE(sets.Union(2, 3));
  EXPECT_FALSE(sets.Union(1, 4));
  EXPECT_EQ(sets.Labels(), (std::vector<std::size_t>{0, 1, 2, 2, 1}));
}

}  // namespace
}  // namespace lowlap
