#include "lowlap/averaging/strategies/internal/bounded_lengths.h"

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "averaging/strategies/small_directions.h"

namespace lowlap {
namespace {

// C_second - C_first - s d at the best s of at least 1.
struct BoundedError {
  template <typename T>
  bool operator()(const T* first, const T* second, T* residual) const {
    T along(0);
    for (int axis = 0; axis < 3; ++axis) {
      residual[axis] = second[axis] - first[axis];
      along += residual[axis] * direction(axis);
    }
    const T length = along > T(1) ? along : T(1);
    for (int axis = 0; axis < 3; ++axis) {
      residual[axis] -= length * direction(axis);
    }
    return true;
  }
  Vec3 direction;
};

// The cost that Ceres reaches with this loss (owned) and lengths of at least 1.
double MinimiseBounded(const DirectionPart& part, ceres::LossFunction* loss,
                       std::vector<Vec3>* centers) {
  ceres::Problem problem;
  for (const DirectionEdge& edge : part.edges) {
    problem.AddResidualBlock(
        new ceres::AutoDiffCostFunction<BoundedError, 3, 3, 3>(
            new BoundedError{edge.direction_in_world}),
        loss, (*centers)[edge.first].data(), (*centers)[edge.second].data());
  }
  problem.SetParameterBlockConstant((*centers)[0].data());
  return SolveWithCeres(&problem);
}

std::vector<Vec3> SolveBounded(const DirectionPart& part,
                               const BoundedLengthsOptions& options) {
  int iterations = 0;
  const auto centers =
      SolveBoundedLengths(part, options, RunContext(), &iterations);
  EXPECT_TRUE(centers);
  EXPECT_GT(iterations, 0);
  return *centers;
}

// Sum of unsquared residuals at lengths of at least one.
double UnsquaredSum(const DirectionPart& part,
                    const std::vector<Vec3>& centers) {
  double sum = 0;
  for (const DirectionEdge& edge : part.edges) {
    const Vec3 offset = centers[edge.second] - centers[edge.first];
    const double length = std::max(1.0, edge.direction_in_world.dot(offset));
    sum += (offset - length * edge.direction_in_world).norm();
  }
  return sum;
}

class BoundedLengths : public ::testing::TestWithParam<int> {
 protected:
  SmallDirections small_ =
      MakeNoisyDirections(static_cast<std::uint64_t>(GetParam()));
};

TEST_P(BoundedLengths, LeastSquaresMeetCeres) {
  const std::vector<Vec3> ours =
      SolveBounded(small_.part, BoundedLengthsOptions::L2Chordal());
  std::vector<Vec3> theirs = small_.made.centers;
  const double cost = MinimiseBounded(small_.part, nullptr, &theirs);
  EXPECT_NEAR(BoundedObjective(small_.part, HUGE_VAL, ours), cost, 1e-9 * cost);
  EXPECT_LT(GaugeFreeError(theirs, ours, std::vector<bool>(10, true)), 1e-5);
}

TEST_P(BoundedLengths, SoftL1MeetsCeres) {
  constexpr double kWidth = 0.01;
  const double ours = BoundedObjective(
      small_.part, kWidth,
      SolveBounded(small_.part, BoundedLengthsOptions::SoftL1()));
  std::vector<Vec3> centers = small_.made.centers;
  double theirs = 0;
  for (const double width : {1.0, 0.1, kWidth}) {
    theirs =
        MinimiseBounded(small_.part, new ceres::SoftLOneLoss(width), &centers);
  }
  EXPECT_NEAR(ours, theirs, 1e-6 * theirs);
}

TEST_P(BoundedLengths, LudMeetsCeres) {
  const double ours = UnsquaredSum(
      small_.part, SolveBounded(small_.part, BoundedLengthsOptions::Lud()));
  std::vector<Vec3> centers = small_.made.centers;
  for (const double width : {1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-5}) {
    MinimiseBounded(small_.part, new ceres::SoftLOneLoss(width), &centers);
  }
  const double theirs = UnsquaredSum(small_.part, centers);
  EXPECT_LE(ours, theirs * (1 + 1e-5));
  EXPECT_NEAR(ours, theirs, 1e-3 * theirs);
}

INSTANTIATE_TEST_SUITE_P(Seeds, BoundedLengths, ::testing::Range(1, 5));

TEST(BoundedObjective, IsTheLossOfWhatMissesALengthOfAtLeastOne) {
  DirectionPart part = MakeTriangle().part;
  // Edge 0 along x; the others have no residual.
  std::vector<Vec3> centers = {Vec3::Zero(), Vec3(2, 0, 0), Vec3(1, 3, 0)};
  part.edges.resize(1);
  EXPECT_EQ(BoundedObjective(part, HUGE_VAL, centers), 0);
  centers[1] = Vec3(0.25, 0, 0);  // too short by 0.75
  EXPECT_DOUBLE_EQ(BoundedObjective(part, HUGE_VAL, centers), 0.5 * 0.5625);
  centers[1] = Vec3(-3, 0, 0);  // behind: 4 from the shortest length
  EXPECT_DOUBLE_EQ(BoundedObjective(part, HUGE_VAL, centers), 8);
  centers[1] = Vec3(5, 4, 0);  // beside by 4, at any length
  EXPECT_DOUBLE_EQ(BoundedObjective(part, HUGE_VAL, centers), 8);
  // b^2 (sqrt(1 + (4 / b)^2) - 1)
  EXPECT_DOUBLE_EQ(BoundedObjective(part, 3, centers), 9 * (5.0 / 3 - 1));
  EXPECT_NEAR(BoundedObjective(part, 1e-6, centers) / 1e-6, 4, 1e-5);
}

TEST(BoundedLengthsOptions, OfTheThreeMethodsDifferInTheWidth) {
  EXPECT_EQ(BoundedLengthsOptions::L2Chordal().loss_width, HUGE_VAL);
  EXPECT_EQ(BoundedLengthsOptions::SoftL1().loss_width, 0.01);
  EXPECT_EQ(BoundedLengthsOptions::Lud().loss_width, 1e-6);
  EXPECT_TRUE(BoundedLengthsOptions::L2Chordal().Validate());
  for (const BoundedLengthsOptions& wrong :
       {BoundedLengthsOptions{0, 10}, BoundedLengthsOptions{-1, 10},
        BoundedLengthsOptions{std::nan(""), 10},
        BoundedLengthsOptions{0.1, 0}}) {
    const Status status = wrong.Validate();
    ASSERT_FALSE(status);
    EXPECT_EQ(status.error().code, ErrorCode::kInvalidArgument);
  }
}

class BoundedMethods : public ::testing::TestWithParam<double> {
 protected:
  const BoundedLengthsOptions options_{GetParam(), 300};
};

TEST_P(BoundedMethods, ExactDirectionsLeaveNoResidualAndNoShortLength) {
  const SmallDirections small = PartOf(MakeTenViews(7));
  const std::vector<Vec3> centers = SolveBounded(small.part, options_);
  EXPECT_EQ(centers[0], Vec3(0, 0, 0));
  EXPECT_LT(
      GaugeFreeError(small.made.centers, centers, std::vector<bool>(10, true)),
      1e-6);
  for (const DirectionEdge& edge : small.part.edges) {
    const Vec3 offset = centers[edge.second] - centers[edge.first];
    EXPECT_GT(edge.direction_in_world.dot(offset), 1 - 1e-6);
  }
}

TEST_P(BoundedMethods, AddToTheIterations) {
  const SmallDirections small = MakeNoisyDirections(5);
  int once = 0, twice = 0;
  ASSERT_TRUE(SolveBoundedLengths(small.part, options_, RunContext(), &once));
  twice = once;
  ASSERT_TRUE(SolveBoundedLengths(small.part, options_, RunContext(), &twice));
  EXPECT_GT(once, 0);
  EXPECT_EQ(twice, 2 * once);
}

TEST_P(BoundedMethods, StopWhenTheyAreAskedTo) {
  const SmallDirections small = MakeNoisyDirections(5);
  for (const int question : {1, 3}) {
    int iterations = 0;
    const auto stopped = SolveBoundedLengths(small.part, options_,
                                             StopAt(question), &iterations);
    ASSERT_FALSE(stopped);
    EXPECT_EQ(stopped.error().code, ErrorCode::kCancelled);
  }
}

INSTANTIATE_TEST_SUITE_P(Widths, BoundedMethods,
                         ::testing::Values(HUGE_VAL, 0.01, 1e-6));

}  // namespace
}  // namespace lowlap
