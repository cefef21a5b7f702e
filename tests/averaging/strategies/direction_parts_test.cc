#include "lowlap/averaging/strategies/internal/direction_parts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "averaging/random_problem.h"

namespace lowlap {
namespace {

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;
using Views = std::vector<std::size_t>;

RandomProblem Directions(std::size_t num_views, const Edges& edges,
                         std::uint64_t seed) {
  return MakeRandomProblem(num_views, edges, seed, /*with_ratios=*/false);
}

void MoveCenters(RandomProblem* made, const std::vector<Vec3>& centers) {
  made->centers = centers;
  for (DirectionEdge& edge : made->problem.edges) {
    edge.direction_in_world =
        (centers[edge.second] - centers[edge.first]).normalized();
  }
}

TEST(DirectionParts, AChainHasNone) {
  const RandomProblem made = Directions(5, {{0, 1}, {1, 2}, {2, 3}, {3, 4}}, 1);
  EXPECT_TRUE(FindDirectionParts(made.problem)->empty());
}

TEST(DirectionParts, AnEmptyProblemHasNone) {
  EXPECT_TRUE(FindDirectionParts(TranslationProblem())->empty());
}

TEST(DirectionParts, TrianglesThatShareAnEdgeAreOne) {
  const RandomProblem made =
      Directions(4, {{0, 1}, {1, 2}, {2, 0}, {3, 1}, {3, 2}}, 2);
  const std::vector<DirectionPart> parts = *FindDirectionParts(made.problem);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].views, (Views{0, 1, 2, 3}));
  EXPECT_EQ(parts[0].edges.size(), 5U);
}

TEST(DirectionParts, TrianglesThatShareAViewAreTwo) {
  const RandomProblem made = Directions(
      6, {{3, 4}, {4, 5}, {5, 3}, {0, 1}, {1, 2}, {2, 0}, {2, 3}}, 3);
  RandomProblem hinged =
      Directions(5, {{2, 3}, {3, 4}, {4, 2}, {0, 1}, {1, 2}, {2, 0}}, 3);
  EXPECT_EQ(FindDirectionParts(made.problem)->size(), 2U);
  const std::vector<DirectionPart> parts = *FindDirectionParts(hinged.problem);
  ASSERT_EQ(parts.size(), 2U);
  EXPECT_EQ(parts[0].views, (Views{0, 1, 2}));
  EXPECT_EQ(parts[1].views, (Views{2, 3, 4}));
}

TEST(DirectionParts, APendantViewIsInNone) {
  const RandomProblem made = Directions(4, {{0, 1}, {1, 2}, {2, 0}, {2, 3}}, 4);
  const std::vector<DirectionPart> parts = *FindDirectionParts(made.problem);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].views, (Views{0, 1, 2}));
}

TEST(DirectionParts, AQuadrilateralIsRigidUnlessItIsFlat) {
  const Edges ring = {{0, 1}, {1, 2}, {2, 3}, {3, 0}};
  RandomProblem made = Directions(4, ring, 5);
  MoveCenters(&made, {{0, 0, 0}, {2, 0, 1}, {2, 2, 0}, {0, 2, 1.5}});
  ASSERT_EQ(FindDirectionParts(made.problem)->size(), 1U);
  MoveCenters(&made, {{0, 0, 0}, {2, 0, 0}, {2, 2, 0}, {0, 3, 0}});
  EXPECT_TRUE(FindDirectionParts(made.problem)->empty());
}

TEST(DirectionParts, ThreeBodiesInARingAreOne) {
  // Triangles {0,1,2}, {2,3,4}, {4,5,0}: they meet in views 0, 2 and 4.
  const RandomProblem made = Directions(
      6,
      {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4}, {4, 2}, {4, 5}, {5, 0}, {0, 4}},
      6);
  const std::vector<DirectionPart> parts = *FindDirectionParts(made.problem);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].views.size(), 6U);
}

TEST(DirectionParts, CollinearCentersDetermineNothing) {
  Edges edges;
  for (std::size_t a = 0; a < 6; ++a) {
    for (std::size_t b = a + 1; b < 6; ++b) edges.push_back({a, b});
  }
  RandomProblem made = Directions(6, edges, 7);
  std::vector<Vec3> centers;
  for (int n = 0; n < 6; ++n) {
    centers.push_back(Vec3(1 + n * n, 2.0 * n * n, -n * n));
  }
  MoveCenters(&made, centers);
  EXPECT_TRUE(FindDirectionParts(made.problem)->empty());

  // Errors well below what counts as an intersection.
  Random random(8);
  for (DirectionEdge& edge : made.problem.edges) {
    edge.direction_in_world =
        (edge.direction_in_world + RandomVector(&random, 0.02)).normalized();
  }
  EXPECT_TRUE(FindDirectionParts(made.problem)->empty());

  // One wrong direction is no reason to believe in lengths.
  made.problem.edges[4].direction_in_world = Vec3::UnitX();
  EXPECT_TRUE(FindDirectionParts(made.problem)->empty());
}

TEST(DirectionParts, AViewBesideALineHoldsTheLine) {
  Edges edges;
  for (std::size_t a = 0; a < 4; ++a) {
    for (std::size_t b = a + 1; b < 5; ++b) edges.push_back({a, b});
  }
  RandomProblem made = Directions(5, edges, 9);
  MoveCenters(&made, {{0, 0, 0}, {1, 0, 0}, {3, 0, 0}, {4, 0, 0}, {2, 2, 0}});
  const std::vector<DirectionPart> parts = *FindDirectionParts(made.problem);
  ASSERT_EQ(parts.size(), 1U);
  EXPECT_EQ(parts[0].views.size(), 5U);
}

TEST(SolveDirectionParts, GivesEveryPartAComponentAndNamesTheRest) {
  // Two triangles hinged in view 2, a pendant view 7, an isolated view 8, and
  // a part of four views 3, 4, 5, 6 with its own edge to view 7.
  const RandomProblem made = Directions(9,
                                        {{0, 1},
                                         {1, 2},
                                         {2, 0},
                                         {3, 4},
                                         {4, 5},
                                         {5, 3},
                                         {6, 4},
                                         {6, 5},
                                         {6, 7},
                                         {2, 3}},
                                        10);
  int calls = 0;
  const auto solution = SolveDirectionParts(
      made.problem, RunContext(),
      [&](const DirectionPart& part, const RunContext&,
          int*) -> Result<std::vector<Vec3>> {
        ++calls;
        return std::vector<Vec3>(part.views.size(), Vec3::UnitX() * calls);
      });
  ASSERT_TRUE(solution);
  EXPECT_EQ(calls, 2);
  EXPECT_EQ(solution->num_components, 2);
  EXPECT_EQ(solution->component,
            (std::vector<int>{1, 1, 1, 0, 0, 0, 0, -1, -1}));
  EXPECT_EQ(solution->center_in_world[4].x(), 1);
  EXPECT_EQ(solution->center_in_world[0].x(), 2);
}

TEST(SolveDirectionParts, PassesErrorsOn) {
  const RandomProblem made = Directions(3, {{0, 1}, {1, 2}, {2, 0}}, 11);
  const auto solution =
      SolveDirectionParts(made.problem, RunContext(),
                          [](const DirectionPart&, const RunContext&,
                             int*) -> Result<std::vector<Vec3>> {
                            return MakeError(ErrorCode::kNumerical, "no");
                          });
  ASSERT_FALSE(solution);
  EXPECT_EQ(solution.error().code, ErrorCode::kNumerical);
}

}  // namespace
}  // namespace lowlap
