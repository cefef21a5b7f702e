// The strategies on directions against Ceres and against random steps.

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "averaging/random_problem.h"
#include "lowlap/averaging/averager_registry.h"
#include "lowlap/averaging/strategies/internal/bata.h"
#include "lowlap/averaging/strategies/internal/bounded_lengths.h"
#include "lowlap/averaging/strategies/internal/revised_lud.h"

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

double Solve(ceres::Problem* problem) {
  ceres::Solver::Options options;
  options.linear_solver_type = ceres::DENSE_QR;
  options.max_num_iterations = 1000;
  options.function_tolerance = 1e-15;
  options.gradient_tolerance = 1e-14;
  options.parameter_tolerance = 1e-14;
  options.logging_type = ceres::SILENT;
  ceres::Solver::Summary summary;
  ceres::Solve(options, problem, &summary);
  return summary.final_cost;
}

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
  return Solve(&problem);
}

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
  return Solve(&problem);
}

// Ten views, 25 edges, errors of 0.03 rad, two directions quite wrong.
struct SmallProblem {
  RandomProblem made;
  DirectionPart part;
};

SmallProblem MakeSmallProblem(std::uint64_t seed) {
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  for (std::size_t n = 0; n < 10; ++n) edges.push_back({n, (n + 1) % 10});
  for (std::size_t n = 0; n < 10; ++n) edges.push_back({n, (n + 2) % 10});
  for (std::size_t n = 0; n < 5; ++n) edges.push_back({n, n + 5});
  SmallProblem small;
  small.made = MakeRandomProblem(10, edges, seed, /*with_ratios=*/false);
  Random random(seed + 100);
  std::size_t n = 0;
  for (DirectionEdge& edge : small.made.problem.edges) {
    const double size = n++ % 12 == 5 ? 0.8 : 0.03;
    edge.stddev_rad = 0.005;
    edge.direction_in_world =
        (edge.direction_in_world + RandomVector(&random, size)).normalized();
  }
  const std::vector<DirectionPart> parts =
      *FindDirectionParts(small.made.problem);
  EXPECT_EQ(parts.size(), 1U);
  small.part = parts.at(0);
  EXPECT_EQ(small.part.views.size(), 10U);
  EXPECT_EQ(small.part.edges.size(), 25U);
  return small;
}

std::vector<Vec3> CentersOf(const std::string& name,
                            const SmallProblem& small) {
  const auto averager = AveragerRegistry::WithBuiltIns().Make(name);
  const auto solution = (*averager)->Solve(small.made.problem, RunContext());
  EXPECT_TRUE(solution);
  return solution->center_in_world;
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

class DirectionSolvers : public ::testing::TestWithParam<int> {
 protected:
  SmallProblem small_ =
      MakeSmallProblem(static_cast<std::uint64_t>(GetParam()));
};

TEST_P(DirectionSolvers, LeastSquaresMeetsCeres) {
  const std::vector<Vec3> ours = CentersOf("l2_chordal", small_);
  std::vector<Vec3> theirs = small_.made.centers;
  const double cost = MinimiseBounded(small_.part, nullptr, &theirs);
  EXPECT_NEAR(BoundedObjective(small_.part, HUGE_VAL, ours), cost, 1e-9 * cost);
  EXPECT_LT(GaugeFreeError(theirs, ours, std::vector<bool>(10, true)), 1e-5);
}

TEST_P(DirectionSolvers, SoftL1MeetsCeres) {
  constexpr double kWidth = 0.01;
  const double ours =
      BoundedObjective(small_.part, kWidth, CentersOf("soft_l1", small_));
  std::vector<Vec3> centers = small_.made.centers;
  double theirs = 0;
  for (const double width : {1.0, 0.1, kWidth}) {
    theirs =
        MinimiseBounded(small_.part, new ceres::SoftLOneLoss(width), &centers);
  }
  EXPECT_NEAR(ours, theirs, 1e-6 * theirs);
}

TEST_P(DirectionSolvers, LudMeetsCeres) {
  const double ours = UnsquaredSum(small_.part, CentersOf("lud", small_));
  std::vector<Vec3> centers = small_.made.centers;
  for (const double width : {1.0, 0.1, 0.01, 1e-3, 1e-4, 1e-5}) {
    MinimiseBounded(small_.part, new ceres::SoftLOneLoss(width), &centers);
  }
  const double theirs = UnsquaredSum(small_.part, centers);
  EXPECT_LE(ours, theirs * (1 + 1e-5));
  EXPECT_NEAR(ours, theirs, 1e-3 * theirs);
}

TEST_P(DirectionSolvers, RevisedLudIsALocalAndSoGlobalMinimum) {
  // The program is convex: no random step within the constraint goes down.
  const std::vector<Vec3> centers = CentersOf("revised_lud", small_);
  const auto cost = [&](const std::vector<Vec3>& at) {
    double sum = 0, reach = 0;
    for (const DirectionEdge& edge : small_.part.edges) {
      const Vec3 offset = at[edge.second] - at[edge.first];
      sum += edge.direction_in_world.cross(offset).norm();
      reach += edge.direction_in_world.dot(offset);
    }
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

TEST_P(DirectionSolvers, BataMeetsCeresFromTheSameStart) {
  int iterations = 0;
  const auto start =
      SolveRevisedLud(small_.part, {}, RunContext(), &iterations);
  ASSERT_TRUE(start);
  const double theirs = MinimiseAngles(small_.part, *start);
  const double jointly =
      AngleObjective(small_.part, CentersOf("revised_bata", small_));
  const double by_blocks =
      AngleObjective(small_.part, CentersOf("bata", small_));
  EXPECT_NEAR(jointly, theirs, 1e-5 * theirs);
  // A hundred steps of block descent do not quite reach the minimum.
  EXPECT_GE(by_blocks, jointly * (1 - 1e-6));
  EXPECT_LE(by_blocks, jointly * 1.02);
  EXPECT_LT(jointly, AngleObjective(small_.part, *start));
}

INSTANTIATE_TEST_SUITE_P(Seeds, DirectionSolvers, ::testing::Range(1, 5));

}  // namespace
}  // namespace lowlap
