#include "lowlap/averaging/strategies/internal/direction_merging.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "averaging/random_problem.h"

namespace lowlap {
namespace {

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;
using Labels = std::vector<std::size_t>;

TranslationProblem Directions(const std::vector<Vec3>& centers,
                              const Edges& edges) {
  RandomProblem made =
      MakeRandomProblem(centers.size(), edges, 1, /*with_ratios=*/false);
  for (DirectionEdge& edge : made.problem.edges) {
    edge.direction_in_world =
        (centers[edge.second] - centers[edge.first]).normalized();
  }
  return made.problem;
}

Labels LabelsOf(const TranslationProblem& problem) {
  const auto labels = LabelRigidEdges(problem, RunContext());
  EXPECT_TRUE(labels);
  return *labels;
}

// Two bends of a path, a triangle, and an edge that hangs on it.
TEST(LabelRigidEdges, ATriangleIsOneAndAPathIsNot) {
  const std::vector<Vec3> centers = {{0, 0, 0}, {1, 0, 0}, {1, 1, 0},
                                     {2, 1, 1}, {0, 3, 2}, {5, 5, 5}};
  EXPECT_EQ(LabelsOf(Directions(centers, {{0, 1}, {1, 2}, {2, 3}})),
            (Labels{0, 1, 2}));
  EXPECT_EQ(
      LabelsOf(Directions(centers, {{0, 1}, {2, 3}, {3, 4}, {4, 2}, {4, 5}})),
      (Labels{0, 1, 1, 1, 2}));
  EXPECT_EQ(LabelsOf(Directions(centers, {})), Labels());
}

// A triangle whose smallest angle is ten deviations wide counts, one of a
// single deviation does not, nor if that is the deviation of one direction
// alone.
TEST(LabelRigidEdges, AnglesMustBeWellAboveTheDeviations) {
  TranslationProblem problem = Directions({{0, 0, 0}, {1, 0.15, 0}, {2, 0, 0}},
                                          {{0, 1}, {1, 2}, {0, 2}});
  const double smallest = std::sin(std::atan(0.15));
  const auto labels_at = [&](double stddev_rad) {
    for (DirectionEdge& edge : problem.edges) edge.stddev_rad = stddev_rad;
    return LabelsOf(problem);
  };
  EXPECT_EQ(labels_at(0.99 * smallest / 10), (Labels{0, 0, 0}));
  EXPECT_EQ(labels_at(smallest), (Labels{0, 1, 2}));
  for (DirectionEdge& edge : problem.edges) edge.stddev_rad = 0.001;
  problem.edges[1].stddev_rad = smallest;
  EXPECT_EQ(LabelsOf(problem), (Labels{0, 1, 2}));
}

// The tetrahedral ring 0-1-2-3 is rigid in space, flat it is not.
TEST(LabelRigidEdges, ARingOfFourEdgesHoldsIfItIsNotFlat) {
  const Edges ring = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  EXPECT_EQ(
      LabelsOf(Directions({{0, 0, 0}, {2, 0, 1}, {2, 2, 0}, {0, 2, 1}}, ring)),
      (Labels{0, 0, 0, 0}));
  EXPECT_EQ(
      LabelsOf(Directions({{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 3, 0}}, ring)),
      (Labels{0, 1, 2, 3}));
  // Five edges in a ring have more lengths than space has axes.
  EXPECT_EQ(LabelsOf(Directions(
                {{0, 0, 0}, {2, 0, 1}, {3, 2, 0}, {1, 4, 1}, {-1, 2, 0.5}},
                {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}})),
            (Labels{0, 1, 2, 3, 4}));
}

TEST(LabelRigidEdges, DoesNotDependOnOrderSidesAndFrame) {
  Random random(2);
  std::vector<Vec3> centers;
  for (int n = 0; n < 12; ++n) centers.push_back(RandomVector(&random, 5));
  // Two bodies that share view 5, and a path.
  Edges edges = {{0, 1}, {1, 2}, {2, 3},  {3, 0},  {0, 4}, {3, 4},
                 {4, 5}, {2, 5}, {5, 6},  {6, 7},  {7, 5}, {7, 8},
                 {6, 8}, {8, 9}, {9, 10}, {10, 11}};
  const auto partition = [](const TranslationProblem& problem) {
    std::map<std::size_t, std::set<std::pair<std::size_t, std::size_t>>> sets;
    const Labels labels = LabelsOf(problem);
    for (std::size_t e = 0; e < labels.size(); ++e) {
      const DirectionEdge& edge = problem.edges[e];
      sets[labels[e]].insert(std::minmax(edge.first, edge.second));
    }
    std::set<std::set<std::pair<std::size_t, std::size_t>>> parts;
    for (const auto& entry : sets) parts.insert(entry.second);
    return parts;
  };
  TranslationProblem problem = Directions(centers, edges);
  for (DirectionEdge& edge : problem.edges) edge.stddev_rad = 0.001;
  const auto expected = partition(problem);
  EXPECT_EQ(expected.size(), 5u);
  const Mat3 turn = RandomRotation(&random);
  for (int trial = 0; trial < 5; ++trial) {
    TranslationProblem other = problem;
    std::rotate(other.edges.begin(), other.edges.begin() + 3 * trial,
                other.edges.end());
    for (std::size_t e = 0; e < other.edges.size(); ++e) {
      DirectionEdge& edge = other.edges[e];
      edge.direction_in_world = turn * edge.direction_in_world;
      if (e % 3 != 0) continue;
      std::swap(edge.first, edge.second);
      edge.direction_in_world *= -1;
    }
    EXPECT_EQ(partition(other), expected) << trial;
  }
}

TEST(LabelRigidEdges, StopsWhenItIsAskedTo) {
  const TranslationProblem problem =
      Directions({{0, 0, 0}, {2, 0, 1}, {2, 2, 0}, {0, 2, 1}},
                 {{0, 1}, {1, 2}, {2, 3}, {3, 0}});
  RunContext context;
  int num_questions = 0, stop_at = 0;
  context.progress = [&](const std::string&, std::size_t done,
                         std::size_t total) {
    EXPECT_LE(done, total);
    return ++num_questions != stop_at;
  };
  ASSERT_TRUE(LabelRigidEdges(problem, context));
  const int all = num_questions;
  ASSERT_GT(all, 2);
  for (stop_at = 1; stop_at <= all; ++stop_at) {
    num_questions = 0;
    const auto stopped = LabelRigidEdges(problem, context);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
    EXPECT_EQ(num_questions, stop_at);
  }
}

}  // namespace
}  // namespace lowlap
