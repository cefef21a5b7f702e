#include "lowlap/averaging/strategies/internal/revised_bata.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <algorithm>

#include "averaging/strategies/small_directions.h"
#include "lowlap/averaging/strategies/internal/bata.h"

namespace lowlap {
namespace {

// q (C_second - C_first) - d.
struct InverseLengthError {
  template <typename T>
  bool operator()(const T* first, const T* second, const T* inverse,
                  T* residual) const {
    for (int axis = 0; axis < 3; ++axis) {
      residual[axis] =
          *inverse * (second[axis] - first[axis]) - direction(axis);
    }
    return true;
  }
  Vec3 direction;
};

// The cost that Ceres reaches with Huber's loss and inverse lengths of at least
// 0, both unknown.
double MinimiseAngles(const DirectionPart& part, std::vector<Vec3> centers) {
  std::vector<double> inverse(part.edges.size());
  ceres::Problem problem;
  auto* loss = new ceres::HuberLoss(kAngleHuber);
  for (std::size_t e = 0; e < part.edges.size(); ++e) {
    const DirectionEdge& edge = part.edges[e];
    const Vec3 offset = centers[edge.second] - centers[edge.first];
    inverse[e] = std::max(
        0.0, edge.direction_in_world.dot(offset) / offset.squaredNorm());
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<InverseLengthError, 3, 3, 3, 1>(
            new InverseLengthError{edge.direction_in_world}),
        loss, centers[edge.first].data(), centers[edge.second].data(),
        &inverse[e]);
    problem.SetParameterLowerBound(&inverse[e], 0, 0.0);
  }
  problem.SetParameterBlockConstant(centers[0].data());
  return SolveWithCeres(&problem);
}

std::vector<Vec3> Solve(const DirectionPart& part) {
  int iterations = 0;
  const auto centers = SolveRevisedBata(part, {}, RunContext(), &iterations);
  EXPECT_TRUE(centers);
  return *centers;
}

class RevisedBata : public ::testing::TestWithParam<int> {
 protected:
  SmallDirections small_ =
      MakeNoisyDirections(static_cast<std::uint64_t>(GetParam()));
};

TEST_P(RevisedBata, MeetsCeresFromTheSameStart) {
  int iterations = 0;
  const auto start =
      SolveRevisedLud(small_.part, {}, RunContext(), &iterations);
  ASSERT_TRUE(start);
  const double theirs = MinimiseAngles(small_.part, *start);
  const double ours = AngleObjective(small_.part, Solve(small_.part));
  EXPECT_NEAR(ours, theirs, 1e-5 * theirs);
  EXPECT_LT(ours, AngleObjective(small_.part, *start));
}

TEST_P(RevisedBata, FixesTheScaleByTheMeanLength) {
  const std::vector<Vec3> centers = Solve(small_.part);
  double total = 0;
  for (const DirectionEdge& edge : small_.part.edges) {
    total += (centers[edge.second] - centers[edge.first]).norm();
  }
  EXPECT_NEAR(total / 25, 1, 1e-12);
  EXPECT_EQ(centers[0], Vec3(0, 0, 0));
}

INSTANTIATE_TEST_SUITE_P(Seeds, RevisedBata, ::testing::Range(1, 5));

TEST(SolveRevisedBata, LeavesExactDirectionsExact) {
  const SmallDirections small = PartOf(MakeTenViews(7));
  EXPECT_LT(GaugeFreeError(small.made.centers, Solve(small.part),
                           std::vector<bool>(10, true)),
            1e-8);
}

TEST(SolveRevisedBata, AddsToTheIterationsAndStopsWhenAskedTo) {
  const SmallDirections small = MakeNoisyDirections(5);
  int of_start = 0, all = 0;
  ASSERT_TRUE(SolveRevisedLud(small.part, {}, RunContext(), &of_start));
  ASSERT_TRUE(SolveRevisedBata(small.part, {}, RunContext(), &all));
  EXPECT_GT(all, of_start);
  int iterations = 7;
  ASSERT_TRUE(SolveRevisedBata(small.part, {2}, RunContext(), &iterations));
  EXPECT_LE(iterations, 7 + of_start + 2);
  for (const int question : {1, of_start + 1, of_start + 2}) {
    iterations = 0;
    const auto stopped =
        SolveRevisedBata(small.part, {}, StopAt(question), &iterations);
    ASSERT_FALSE(stopped) << question;
    EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
  }
}

}  // namespace
}  // namespace lowlap
