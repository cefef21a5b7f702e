#include "lowlap/averaging/strategies/internal/direction_system.h"

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>

#include "averaging/strategies/small_directions.h"

namespace lowlap {
namespace {

// H of all views, gauge free.
Eigen::MatrixXd DenseHessian(const DirectionPart& part,
                             const std::vector<Mat3>& weights) {
  const auto size = static_cast<Eigen::Index>(3 * part.views.size());
  Eigen::MatrixXd hessian = Eigen::MatrixXd::Zero(size, size);
  for (std::size_t e = 0; e < part.edges.size(); ++e) {
    Eigen::MatrixXd difference = Eigen::MatrixXd::Zero(3, size);
    difference.middleCols<3>(3 * part.edges[e].second).setIdentity();
    difference.middleCols<3>(3 * part.edges[e].first) = -Mat3::Identity();
    hessian += difference.transpose() * weights[e] * difference;
  }
  return hessian;
}

std::vector<Mat3> RandomWeights(std::size_t count, std::uint64_t seed) {
  Random random(seed);
  std::vector<Mat3> weights;
  for (std::size_t n = 0; n < count; ++n) {
    Mat3 root;
    for (int c = 0; c < 3; ++c) root.col(c) = RandomVector(&random, 1);
    weights.push_back(root * root.transpose() + 0.1 * Mat3::Identity());
  }
  return weights;
}

TEST(DirectionSystem, SolvesTheNormalEquationsWithViewZeroFixed) {
  const SmallDirections small = PartOf(MakeTenViews(1));
  Random random(2);
  std::vector<Vec3> forces;
  for (std::size_t n = 0; n < 10; ++n) {
    forces.push_back(RandomVector(&random, 1));
  }
  DirectionSystem system(small.part);
  // The same system for other weights, of which some are 0.
  for (const std::uint64_t seed : {3, 4, 5}) {
    std::vector<Mat3> weights = RandomWeights(25, seed);
    if (seed == 4) weights[3].setZero();
    for (const double damping : {0.0, 0.7}) {
      ASSERT_TRUE(system.Factor(weights, damping));
      const auto centers = system.Solve(forces);
      ASSERT_TRUE(centers);
      EXPECT_EQ((*centers)[0], Vec3(0, 0, 0));
      Eigen::MatrixXd reduced =
          DenseHessian(small.part, weights).bottomRightCorner(27, 27);
      reduced.diagonal().array() += damping * reduced.diagonal().mean();
      Eigen::VectorXd x(27), b(27);
      for (Eigen::Index n = 0; n < 9; ++n) {
        x.segment<3>(3 * n) = (*centers)[n + 1];
        b.segment<3>(3 * n) = forces[n + 1];
      }
      EXPECT_LT((reduced * x - b).norm(), 1e-11 * b.norm());
    }
  }
}

TEST(DirectionSystem, IgnoresTheForceOnViewZero) {
  const SmallDirections triangle = MakeTriangle();
  DirectionSystem system(triangle.part);
  ASSERT_TRUE(system.Factor(std::vector<Mat3>(3, Mat3::Identity()), 0));
  std::vector<Vec3> forces = {Vec3::Zero(), Vec3(1, 0, 0), Vec3(0, 2, 0)};
  const std::vector<Vec3> centers = *system.Solve(forces);
  // H = [2 -1; -1 2] per axis.
  EXPECT_LT((centers[1] - Vec3(2.0 / 3, 2.0 / 3, 0)).norm(), 1e-14);
  EXPECT_LT((centers[2] - Vec3(1.0 / 3, 4.0 / 3, 0)).norm(), 1e-14);
  forces[0] = Vec3(7, 8, 9);
  EXPECT_EQ(*system.Solve(forces), centers);
}

TEST(DirectionSystem, TellsWhatItCannotFactor) {
  const SmallDirections triangle = MakeTriangle();
  DirectionSystem system(triangle.part);
  for (const double value : {0.0, std::nan("")}) {
    std::vector<Mat3> weights(3, Mat3::Identity());
    weights[1] = value * Mat3::Identity();
    weights[2] = value * Mat3::Identity();
    const Status status = system.Factor(weights, 0);
    if (value == 0) {
      ASSERT_FALSE(status);
      EXPECT_EQ(status.error().code, ErrorCode::kNumerical);
      continue;
    }
    // What is not finite is found out in the end.
    if (!status) continue;
    const auto centers = system.Solve(std::vector<Vec3>(3, Vec3::Ones()));
    ASSERT_FALSE(centers);
    EXPECT_EQ(centers.error().code, ErrorCode::kNumerical);
  }
  EXPECT_TRUE(system.Factor(std::vector<Mat3>(3, Mat3::Identity()), 0));
}

}  // namespace
}  // namespace lowlap
