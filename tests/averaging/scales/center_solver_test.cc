#include "lowlap/averaging/scales/internal/center_solver.h"

#include <gtest/gtest.h>

#include <cmath>

#include "averaging/random_problem.h"

namespace lowlap {
namespace {

CenterEdge Between(std::size_t first, std::size_t second, const Vec3& offset) {
  CenterEdge edge;
  edge.first = first;
  edge.second = second;
  edge.direction_in_world = offset.normalized();
  edge.length = offset.norm();
  return edge;
}

// Exact edges between random centres, of which the first is the origin.
struct ExactEdges {
  std::vector<Vec3> centers;
  std::vector<CenterEdge> edges;
};

ExactEdges MakeExact(
    std::size_t num_views,
    const std::vector<std::pair<std::size_t, std::size_t>>& pairs,
    std::uint64_t seed) {
  ExactEdges made;
  Random random(seed);
  for (std::size_t n = 0; n < num_views; ++n) {
    made.centers.push_back(RandomVector(&random, 5));
  }
  made.centers[0].setZero();
  for (const auto& [a, b] : pairs) {
    made.edges.push_back(Between(a, b, made.centers[b] - made.centers[a]));
  }
  return made;
}

double WorstError(const std::vector<Vec3>& a, const std::vector<Vec3>& b) {
  double worst = 0;
  for (std::size_t n = 0; n < a.size(); ++n) {
    worst = std::max(worst, (a[n] - b[n]).norm());
  }
  return worst;
}

TEST(SolveCenters, ReproducesATree) {
  const ExactEdges made =
      MakeExact(6, {{0, 3}, {1, 3}, {3, 2}, {2, 5}, {4, 2}}, 1);
  const auto centers = SolveCenters(6, made.edges);
  ASSERT_TRUE(centers);
  // Information of different edges differs by a factor of 100 or so.
  EXPECT_LT(WorstError(*centers, made.centers), 1e-11);
}

TEST(SolveCenters, PutsTheFirstViewOfEveryComponentAtTheOrigin) {
  ExactEdges made = MakeExact(6, {{0, 4}, {2, 3}, {3, 5}}, 2);
  const auto centers = SolveCenters(6, made.edges);
  ASSERT_TRUE(centers);
  EXPECT_EQ((*centers)[0], Vec3(0, 0, 0));
  EXPECT_EQ((*centers)[1], Vec3(0, 0, 0));  // alone
  EXPECT_EQ((*centers)[2], Vec3(0, 0, 0));
  EXPECT_LT(((*centers)[5] - (made.centers[5] - made.centers[2])).norm(),
            1e-11);
  EXPECT_EQ(*SolveCenters(3, {}), std::vector<Vec3>(3, Vec3(0, 0, 0)));
}

// A view that two edges reach, both of length L at angles of +-a to the x axis.
// By symmetry it is at (c, 0, 0), and both have the same robust weight; then
//   min (c cos a - L)^2 / along^2 + (c sin a)^2 / across^2.
TEST(SolveCenters, WeighsAlongAndAcrossAsStated) {
  constexpr double kAngle = 0.02, kLength = 3;
  for (const double across : {0.01, 0.02, 0.05}) {
    std::vector<CenterEdge> edges;
    for (const double side : {-1.0, 1.0}) {
      edges.push_back(Between(
          0, 1, kLength * Vec3(std::cos(kAngle), side * std::sin(kAngle), 0)));
      edges.back().across_rad = across;
      edges.back().along_log = 0.01;
    }
    const auto centers = SolveCenters(2, edges);
    ASSERT_TRUE(centers);
    const double flat = std::pow(0.01 / across * std::sin(kAngle), 2);
    const double expected =
        kLength * std::cos(kAngle) / (std::pow(std::cos(kAngle), 2) + flat);
    EXPECT_NEAR((*centers)[1].x(), expected, 1e-12);
    EXPECT_NEAR((*centers)[1].y(), 0, 1e-12);
  }
}

TEST(SolveCenters, ForgetsAWrongEdge) {
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t b = a + 1; b < 8; ++b) pairs.push_back({a, b});
  }
  ExactEdges made = MakeExact(8, pairs, 3);
  made.edges[11].direction_in_world *= -1;
  const auto centers = SolveCenters(8, made.edges);
  ASSERT_TRUE(centers);
  // It misses by twice its length, 200 deviations: a Geman-McClure weight of
  // (1 + (200 / 3)^2)^-2 = 5e-8, and a pull of 1e-5 deviations, 1e-7 of its
  // length, against six other ways of two edges.
  EXPECT_LT(WorstError(*centers, made.centers), 1e-5);
}

TEST(SolveCenters, DoesNotDependOnTheSidesOfEdgesAndScalesWithTheLengths) {
  ExactEdges made =
      MakeExact(5, {{0, 1}, {1, 2}, {2, 3}, {3, 4}, {4, 0}, {1, 3}}, 4);
  Random random(5);
  for (CenterEdge& edge : made.edges) edge.length *= random.Uniform(0.95, 1.05);
  const std::vector<Vec3> centers = *SolveCenters(5, made.edges);
  EXPECT_GT(WorstError(centers, made.centers), 1e-3);
  std::vector<CenterEdge> turned = made.edges, longer = made.edges;
  for (CenterEdge& edge : turned) {
    std::swap(edge.first, edge.second);
    edge.direction_in_world *= -1;
  }
  for (CenterEdge& edge : longer) edge.length *= 1000;
  EXPECT_LT(WorstError(*SolveCenters(5, turned), centers), 1e-11);
  std::vector<Vec3> shrunk = *SolveCenters(5, longer);
  for (Vec3& center : shrunk) center /= 1000;
  EXPECT_LT(WorstError(shrunk, centers), 1e-11);
}

TEST(SolveCenters, TellsWhatItCannotSolveAndStops) {
  ExactEdges made = MakeExact(3, {{0, 1}, {1, 2}}, 6);
  made.edges[0].length = 0;
  auto centers = SolveCenters(3, made.edges);
  ASSERT_FALSE(centers);
  EXPECT_EQ(centers.error().code, ErrorCode::kNumerical);

  made = MakeExact(3, {{0, 1}, {1, 2}}, 6);
  RunContext context;
  int num_questions = 0;
  context.progress = [&](const std::string&, std::size_t, std::size_t) {
    ++num_questions;
    return false;
  };
  centers = SolveCenters(3, made.edges, context);
  ASSERT_FALSE(centers);
  EXPECT_EQ(centers.error().code, ErrorCode::kCancelled);
  EXPECT_EQ(num_questions, 1);
}

}  // namespace
}  // namespace lowlap
