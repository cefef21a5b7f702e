#include "lowlap/two_view/internal/search/sandwich_covariance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/two_view/internal/search/refine_relative_pose.h"
#include "support/random_vectors.h"

namespace lowlap {
namespace {

using Residual = Eigen::Matrix<double, 1, 1>;
using Row = Eigen::Matrix<double, 1, 5>;

constexpr double kCell = 0.1;

struct Observation {
  Eigen::Vector2d place;
  Row row;
  double error = 0;
};

// Regression on a polynomial of the place: `per_cell` observations in each cell
// of a grid, with errors of their own and one that the cell has in common.
std::vector<Observation> Observe(int per_cell, double own, double common,
                                 Random& random) {
  std::vector<Observation> observations;
  for (int x = 0; x < 10; ++x) {
    for (int y = 0; y < 10; ++y) {
      const double of_cell = common * random.Gaussian();
      for (int n = 0; n < per_cell; ++n) {
        Observation one;
        one.place =
            kCell * (Vec2(x, y) + testing::UniformVec2(random, {0, 0}, {1, 1}));
        const double u = one.place.x(), v = one.place.y();
        one.row << 1, u, v, u * u, u * v;
        one.error = of_cell + own * random.Gaussian();
        observations.push_back(one);
      }
    }
  }
  return observations;
}

struct Fit {
  Vec5 error = Vec5::Zero();
  std::optional<Mat5> covariance;
};

Fit LeastSquares(const std::vector<Observation>& observations, double cell) {
  Mat5 normal = Mat5::Zero();
  Vec5 right = Vec5::Zero();
  for (const Observation& one : observations) {
    normal += one.row.transpose() * one.row;
    right += one.row.transpose() * one.error;
  }
  Fit fit;
  fit.error = normal.ldlt().solve(right);
  SandwichCovariance<5> sandwich(cell);
  for (const Observation& one : observations) {
    sandwich.Add<1>(one.place, one.row,
                    Residual(one.error - one.row.dot(fit.error)),
                    Residual::Ones());
  }
  fit.covariance = sandwich.Solve();
  return fit;
}

// The mean of e^T C^-1 e, which is 5 for a covariance that holds.
double MeanSquaredError(double own, double common, double cell) {
  constexpr int kNumTrials = 150;
  Random random(3);
  double sum = 0;
  for (int trial = 0; trial < kNumTrials; ++trial) {
    const Fit fit = LeastSquares(Observe(8, own, common, random), cell);
    sum += fit.error.dot(fit.covariance->ldlt().solve(fit.error));
  }
  return sum / kNumTrials;
}

TEST(SandwichCovariance, HoldsForIndependentErrors) {
  EXPECT_NEAR(MeanSquaredError(1, 0, 0), 5, 0.8);
}

TEST(SandwichCovariance, NeighboursThatErrTogetherCountAsOne) {
  EXPECT_GT(MeanSquaredError(1, 1, 0), 15);
  const double with_cells = MeanSquaredError(1, 1, 2 * kCell);
  EXPECT_GT(with_cells, 3);
  EXPECT_LT(with_cells, 8);
}

TEST(SandwichCovariance, CellsMakeNothingMoreCertain) {
  Random random(5);
  for (int trial = 0; trial < 20; ++trial) {
    const auto observations = Observe(3, 1, 0, random);
    const Mat5 independent = *LeastSquares(observations, 0).covariance;
    const Mat5 in_cells = *LeastSquares(observations, kCell).covariance;
    const Mat5 more = in_cells - independent;
    EXPECT_GT(more.selfadjointView<Eigen::Lower>().eigenvalues().minCoeff(),
              -1e-9 * independent.norm());
  }
}

TEST(SandwichCovariance, WhereTheLossIsFlatLittleIsKnown) {
  // Two residuals alone know the last parameter; they are far out in the loss.
  const auto variance = [](double outer) {
    SandwichCovariance<5> sandwich(0);
    for (int n = 0; n < 100; ++n) {
      Row row = Row::Zero();
      row[n < 98 ? n % 4 : 4] = 1;
      const CauchyDerivatives<1> loss(
          Residual(n < 98 ? (n % 8 < 4 ? 0.3 : -0.3) : outer), 1.0);
      sandwich.Add<1>({0, 0}, row, loss.gradient, loss.hessian);
    }
    return (*sandwich.Solve())(4, 4);
  };
  EXPECT_GT(variance(0.9), 10 * variance(0.3));
}

TEST(SandwichCovariance, AddsPriors) {
  const auto with_prior = [](double weight) {
    Random random(8);
    SandwichCovariance<5> sandwich(0);
    for (const Observation& one : Observe(1, 1, 0, random)) {
      sandwich.Add<1>(one.place, one.row, Residual(one.error),
                      Residual::Ones());
    }
    const Mat5 prior = weight * Mat5::Identity();
    sandwich.AddPrior(prior, prior);
    return *sandwich.Solve();
  };
  EXPECT_LT(with_prior(1e6).norm(), 1e-4 * with_prior(0).norm());
  // Unit residuals of a prior with weight w: variance 1 / w.
  EXPECT_NEAR(with_prior(1e6)(0, 0), 1e-6, 1e-8);
}

TEST(SandwichCovariance, NeedsMoreResidualsThanParameters) {
  SandwichCovariance<5> sandwich(kCell);
  EXPECT_FALSE(sandwich.Solve());
  for (int n = 0; n < 5; ++n) {
    Row row = Row::Zero();
    row[n] = 1;
    sandwich.Add<1>({0, 0}, row, Residual::Ones(), Residual::Ones());
  }
  EXPECT_FALSE(sandwich.Solve());
}

TEST(SandwichCovariance, RefusesWhatLeavesAParameterFree) {
  SandwichCovariance<5> sandwich(kCell);
  for (int n = 0; n < 50; ++n) {
    Row row = Row::Zero();
    row[n % 4] = 1;
    sandwich.Add<1>({0.01 * n, 0}, row, Residual::Ones(), Residual::Ones());
  }
  EXPECT_FALSE(sandwich.Solve());
}

}  // namespace
}  // namespace lowlap
