#include "lowlap/averaging/strategies/internal/revised_lud.h"

#include <gtest/gtest.h>

#include "averaging/strategies/small_directions.h"

namespace lowlap {
namespace {

std::vector<Vec3> SolveRevisedLud(const DirectionPart& part,
                                  int max_iterations = 200) {
  int iterations = 0;
  const auto centers =
      SolveRevisedLud(part, {max_iterations}, RunContext(), &iterations);
  EXPECT_TRUE(centers);
  EXPECT_GT(iterations, 0);
  EXPECT_LE(iterations, max_iterations);
  return *centers;
}

double Reach(const DirectionPart& part, const std::vector<Vec3>& centers) {
  double reach = 0;
  for (const DirectionEdge& edge : part.edges) {
    reach +=
        edge.direction_in_world.dot(centers[edge.second] - centers[edge.first]);
  }
  return reach;
}

class RevisedLud : public ::testing::TestWithParam<int> {
 protected:
  SmallDirections small_ =
      MakeNoisyDirections(static_cast<std::uint64_t>(GetParam()));
};

TEST_P(RevisedLud, IsALocalAndSoGlobalMinimum) {
  // The program is convex: no random step within the constraint goes down.
  const std::vector<Vec3> centers = SolveRevisedLud(small_.part);
  const auto cost = [&](const std::vector<Vec3>& at) {
    double sum = 0;
    for (const DirectionEdge& edge : small_.part.edges) {
      const Vec3 offset = at[edge.second] - at[edge.first];
      sum += edge.direction_in_world.cross(offset).norm();
    }
    const double reach = Reach(small_.part, at);
    EXPECT_GT(reach, 0);
    return sum * static_cast<double>(small_.part.edges.size()) / reach;
  };
  const double least = cost(centers);
  Random random(7);
  for (const double size : {0.3, 0.1, 0.01, 1e-3, 1e-4}) {
    for (int trial = 0; trial < 500; ++trial) {
      std::vector<Vec3> moved = centers;
      if (trial % 2 == 0) {
        for (Vec3& center : moved) center += RandomVector(&random, size);
      } else {
        moved[static_cast<std::size_t>(trial / 2 % 10)] +=
            RandomVector(&random, size);
      }
      ASSERT_GE(cost(moved), least * (1 - 1e-6));
    }
  }
}

TEST_P(RevisedLud, KeepsItsConstraintFromTheFirstIterationOn) {
  for (const int iterations : {1, 2, 200}) {
    const std::vector<Vec3> centers = SolveRevisedLud(small_.part, iterations);
    EXPECT_EQ(centers[0], Vec3(0, 0, 0));
    EXPECT_NEAR(Reach(small_.part, centers), 25, 1e-9);
  }
}

INSTANTIATE_TEST_SUITE_P(Seeds, RevisedLud, ::testing::Range(1, 5));

TEST(SolveRevisedLud, GivesATriangleTheMeanLengthOne) {
  const SmallDirections triangle = MakeTriangle();
  const std::vector<Vec3> centers = SolveRevisedLud(triangle.part);
  for (std::size_t n = 0; n < 3; ++n) {
    EXPECT_LT((centers[n] - triangle.made.centers[n]).norm(), 1e-9);
  }
}

TEST(SolveRevisedLud, IsExactOnExactDirections) {
  const SmallDirections small = PartOf(MakeTenViews(7));
  EXPECT_LT(GaugeFreeError(small.made.centers, SolveRevisedLud(small.part),
                           std::vector<bool>(10, true)),
            1e-8);
}

TEST(SolveRevisedLud, AddsToTheIterationsAndStopsWhenAskedTo) {
  const SmallDirections small = MakeNoisyDirections(5);
  int once = 0;
  ASSERT_TRUE(SolveRevisedLud(small.part, {}, RunContext(), &once));
  int twice = once;
  ASSERT_TRUE(SolveRevisedLud(small.part, {}, RunContext(), &twice));
  EXPECT_EQ(twice, 2 * once);
  for (const int question : {1, 4}) {
    int iterations = 0;
    const auto stopped =
        SolveRevisedLud(small.part, {}, StopAt(question), &iterations);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
    EXPECT_EQ(iterations, question - 1);
  }
}

TEST(SolveRevisedLud, RefusesDirectionsThatCancelOut) {
  // Both ways between the same views.
  DirectionPart part = MakeTriangle().part;
  part.views = {0, 1};
  part.edges = {part.edges[0], part.edges[0]};
  part.edges[1].direction_in_world *= -1;
  int iterations = 0;
  const auto refused = SolveRevisedLud(part, {}, RunContext(), &iterations);
  ASSERT_FALSE(refused);
  EXPECT_EQ(refused.error().code, ErrorCode::kNumerical);
}

TEST(RevisedLudOptions, NeedIterations) {
  EXPECT_TRUE(RevisedLudOptions().Validate());
  ASSERT_FALSE(RevisedLudOptions{0}.Validate());
  EXPECT_EQ(RevisedLudOptions{0}.Validate().error().code,
            ErrorCode::kInvalidArgument);
}

}  // namespace
}  // namespace lowlap
