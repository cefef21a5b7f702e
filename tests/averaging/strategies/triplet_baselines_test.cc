#include "lowlap/averaging/strategies/internal/triplet_baselines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "averaging/random_problem.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

RandomProblem Directions(const std::vector<Vec3>& centers, const Edges& edges) {
  RandomProblem made =
      MakeRandomProblem(centers.size(), edges, 1, /*with_ratios=*/false);
  made.centers = centers;
  for (DirectionEdge& edge : made.problem.edges) {
    edge.direction_in_world =
        (centers[edge.second] - centers[edge.first]).normalized();
  }
  return made;
}

// A right triangle of sides 3, 4, 5, with one edge against the walk around it.
RandomProblem RightTriangle() {
  return Directions({{0, 0, 0}, {3, 0, 0}, {3, 4, 0}},
                    {{0, 1}, {1, 2}, {0, 2}});
}

// The only triplet.
TripletMotion OnlyTriplet(const TranslationProblem& problem,
                          const TripletProgramOptions& options = {}) {
  const auto sets = FindTripletBaselines(problem, options);
  EXPECT_EQ(sets.size(), 1u);
  if (sets.size() != 1) return {};
  EXPECT_EQ(sets[0].size(), 1u);
  return sets[0][0];
}

TEST(FindTripletBaselines, BoundsTheirNumberWithoutLosingAConnection) {
  Edges edges;
  for (std::size_t a = 0; a < 14; ++a) {
    for (std::size_t b = a + 1; b < 14; ++b) edges.push_back({a, b});
  }
  const RandomProblem made = MakeRandomProblem(14, edges, 13);
  TripletProgramOptions options;
  options.max_triplets_per_edge = 1;
  const auto sets = FindTripletBaselines(made.problem, options);
  ASSERT_EQ(sets.size(), 1u);
  EXPECT_LT(sets[0].size(), 120u);  // of 364
  std::vector<bool> is_held(made.problem.edges.size(), false);
  for (const TripletMotion& motion : sets[0]) {
    for (const std::size_t e : motion.edges) is_held[e] = true;
  }
  EXPECT_EQ(std::count(is_held.begin(), is_held.end(), false), 0);
}

TEST(FindTripletBaselines, BaselinesAreTheTrueOnesUpToScale) {
  const RandomProblem made = MakeRandomProblem(3, Edges{{1, 0}, {1, 2}, {2, 0}},
                                               14, /*with_ratios=*/false);
  const auto sets = FindTripletBaselines(made.problem, {});
  ASSERT_EQ(sets.size(), 1u);
  ASSERT_EQ(sets[0].size(), 1u);
  const TripletMotion& motion = sets[0][0];
  std::vector<double> factors;
  double mean = 0;
  for (int n = 0; n < 3; ++n) {
    const DirectionEdge& edge = made.problem.edges[motion.edges[n]];
    const Vec3 truth = made.centers[edge.second] - made.centers[edge.first];
    EXPECT_GT(truth.dot(motion.baselines[n]), 0);
    factors.push_back(motion.baselines[n].norm() / truth.norm());
    mean += motion.baselines[n].norm() / 3;
  }
  EXPECT_NEAR(mean, 1, 1e-12);
  EXPECT_NEAR(factors[0], factors[1], 1e-9);
  EXPECT_NEAR(factors[0], factors[2], 1e-9);
}

TEST(FindTripletBaselines, HaveTheMeanLengthOneAndTheSidesOfTheirEdges) {
  const TripletMotion motion = OnlyTriplet(RightTriangle().problem);
  EXPECT_EQ(motion.edges, (std::array<std::size_t, 3>{0, 1, 2}));
  EXPECT_FALSE(motion.has_ratio);
  EXPECT_NEAR(motion.closure_rad, 0, 1e-7);  // an arc cosine near 1
  EXPECT_LT((motion.baselines[0] - Vec3(0.75, 0, 0)).norm(), 1e-12);
  EXPECT_LT((motion.baselines[1] - Vec3(0, 1, 0)).norm(), 1e-12);
  EXPECT_LT((motion.baselines[2] - Vec3(0.75, 1, 0)).norm(), 1e-12);
}

TEST(FindTripletBaselines, TakeTheMostMeaningfulRatioForTheLengths) {
  RandomProblem made = RightTriangle();
  made.AddRatio(0, 1, std::log(1.5));  // the second side twice the first
  made.AddRatio(2, 1);
  made.problem.ratios[0].log10_nfa = -40;
  made.problem.ratios[1].log10_nfa = -10;
  TripletProgramOptions options;
  options.max_closure_deg = 180;
  const TripletMotion motion = OnlyTriplet(made.problem, options);
  EXPECT_TRUE(motion.has_ratio);
  const double unit = 3 / (1 + 2 + std::sqrt(5.0));
  EXPECT_LT((motion.baselines[0] - unit * Vec3(1, 0, 0)).norm(), 1e-12);
  EXPECT_LT((motion.baselines[1] - unit * Vec3(0, 2, 0)).norm(), 1e-12);
  // Edge 2 closes the triangle, and misses its own direction.
  EXPECT_LT((motion.baselines[2] - unit * Vec3(1, 2, 0)).norm(), 1e-12);
  EXPECT_NEAR(motion.closure_rad, std::atan2(2, 1) - std::atan2(4, 3), 1e-12);
  // From the other end it is the same.
  std::swap(made.problem.ratios[0].reference, made.problem.ratios[0].target);
  made.problem.ratios[0].log_ratio *= -1;
  const TripletMotion turned = OnlyTriplet(made.problem, options);
  for (int n = 0; n < 3; ++n) {
    EXPECT_LT((turned.baselines[n] - motion.baselines[n]).norm(), 1e-12);
  }
  options.max_closure_deg = DegFromRad(motion.closure_rad) - 1e-6;
  EXPECT_TRUE(FindTripletBaselines(made.problem, options).empty());
}

TEST(FindTripletBaselines, AreNoneWhereNoPositiveLengthsClose) {
  RandomProblem made = RightTriangle();
  made.problem.edges[1].direction_in_world *= -1;
  EXPECT_TRUE(FindTripletBaselines(made.problem, {}).empty());
  EXPECT_TRUE(FindTripletBaselines(TranslationProblem(), {}).empty());
}

TEST(FindTripletBaselines, FlatTrianglesNeedARatio) {
  // Angles of atan(0.1) = 5.7 degrees at both ends.
  RandomProblem made =
      Directions({{0, 0, 0}, {1, 0.1, 0}, {2, 0, 0}}, {{0, 1}, {1, 2}, {0, 2}});
  TripletProgramOptions options;
  const double angle = DegFromRad(std::atan(0.1));
  options.min_angle_deg = angle - 0.01;
  EXPECT_FALSE(OnlyTriplet(made.problem, options).has_ratio);
  options.min_angle_deg = angle + 0.01;
  EXPECT_TRUE(FindTripletBaselines(made.problem, options).empty());
  made.AddRatio(0, 1);
  EXPECT_TRUE(OnlyTriplet(made.problem, options).has_ratio);
}

TEST(FindTripletBaselines, AreInSetsThatCommonEdgesJoinTheLargestFirst) {
  // Triangle 0-1-2, and triangles 2-3-4 and 3-4-5 with a common edge.
  const RandomProblem made = MakeRandomProblem(
      6, Edges{{0, 1}, {1, 2}, {0, 2}, {2, 3}, {3, 4}, {2, 4}, {3, 5}, {4, 5}},
      2);
  const auto sets = FindTripletBaselines(made.problem, {});
  ASSERT_EQ(sets.size(), 2u);
  EXPECT_EQ(sets[0].size(), 2u);
  ASSERT_EQ(sets[1].size(), 1u);
  EXPECT_EQ(sets[1][0].edges, (std::array<std::size_t, 3>{0, 1, 2}));
}

}  // namespace
}  // namespace lowlap
