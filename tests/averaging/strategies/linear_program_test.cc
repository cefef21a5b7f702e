#include "lowlap/averaging/strategies/internal/linear_program.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

constexpr double kInfinity = LinearProgram::kInfinity;

// min c^T x over the box [-1, 1]^3 cut by half spaces a^T x <= b that keep the
// origin: bounded and feasible.
struct CutBox {
  Eigen::Vector3d cost;
  std::vector<Eigen::Vector3d> normals;  // with those of the box
  std::vector<double> bounds;
};

CutBox RandomCutBox(Random* random) {
  CutBox box;
  for (int n = 0; n < 3; ++n) {
    box.cost(n) = random->Uniform(-1, 1);
    box.normals.push_back(Eigen::Vector3d::Unit(n));
    box.normals.push_back(-Eigen::Vector3d::Unit(n));
    box.bounds.insert(box.bounds.end(), {1.0, 1.0});
  }
  for (int n = 0; n < 6; ++n) {
    box.normals.push_back({random->Uniform(-1, 1), random->Uniform(-1, 1),
                           random->Uniform(-1, 1)});
    box.bounds.push_back(random->Uniform(0.05, 0.8));
  }
  return box;
}

// The best of all vertices: intersections of three planes that are feasible.
double BestVertex(const CutBox& box) {
  double best = kInfinity;
  const std::size_t count = box.normals.size();
  for (std::size_t a = 0; a < count; ++a) {
    for (std::size_t b = a + 1; b < count; ++b) {
      for (std::size_t c = b + 1; c < count; ++c) {
        Eigen::Matrix3d planes;
        planes << box.normals[a].transpose(), box.normals[b].transpose(),
            box.normals[c].transpose();
        if (std::abs(planes.determinant()) < 1e-9) continue;
        const Eigen::Vector3d vertex =
            planes.inverse() *
            Eigen::Vector3d(box.bounds[a], box.bounds[b], box.bounds[c]);
        bool is_feasible = true;
        for (std::size_t n = 0; n < count; ++n) {
          is_feasible =
              is_feasible && box.normals[n].dot(vertex) <= box.bounds[n] + 1e-9;
        }
        if (is_feasible) best = std::min(best, box.cost.dot(vertex));
      }
    }
  }
  return best;
}

TEST(LinearProgram, EqualsTheBestOfAllVertices) {
  Random random(11);
  for (int trial = 0; trial < 100; ++trial) {
    const CutBox box = RandomCutBox(&random);
    LinearProgram program;
    for (int n = 0; n < 3; ++n) program.AddVariable(-1, 1, box.cost(n));
    for (std::size_t n = 6; n < box.normals.size(); ++n) {
      const Eigen::Vector3d& a = box.normals[n];
      program.AddRow({{0, a.x()}, {1, a.y()}, {2, a.z()}}, -kInfinity,
                     box.bounds[n]);
    }
    const auto optimum = program.Minimize();
    ASSERT_TRUE(optimum) << optimum.error().ToString();
    EXPECT_NEAR(optimum->objective, BestVertex(box), 1e-7);
    double cost = 0;
    for (int n = 0; n < 3; ++n) cost += box.cost(n) * optimum->values[n];
    EXPECT_NEAR(cost, optimum->objective, 1e-9);
  }
}

TEST(LinearProgram, EqualityRowsHold) {
  // min |x - 3| + |y - 5| with x + y = 6, by excess and lack.
  LinearProgram program;
  const auto x = program.AddVariable(-kInfinity, kInfinity, 0);
  const auto y = program.AddVariable(-kInfinity, 4, 0);
  const auto over_x = program.AddVariable(0, kInfinity, 1);
  const auto under_x = program.AddVariable(0, kInfinity, 1);
  const auto over_y = program.AddVariable(0, kInfinity, 3);
  const auto under_y = program.AddVariable(0, kInfinity, 3);
  program.AddRow({{x, 1}, {y, 1}}, 6, 6);
  program.AddRow({{x, 1}, {over_x, -1}, {under_x, 1}}, 3, 3);
  program.AddRow({{y, 1}, {over_y, -1}, {under_y, 1}}, 5, 5);
  const auto optimum = program.Minimize();
  ASSERT_TRUE(optimum);
  EXPECT_NEAR(optimum->values[x], 2, 1e-9);
  EXPECT_NEAR(optimum->values[y], 4, 1e-9);
  EXPECT_NEAR(optimum->objective, 1 + 3, 1e-9);
}

TEST(LinearProgram, SaysThatThereIsNoOptimum) {
  LinearProgram infeasible;
  const auto x = infeasible.AddVariable(0, 1, 1);
  infeasible.AddRow({{x, 1}}, 2, kInfinity);
  auto optimum = infeasible.Minimize();
  ASSERT_FALSE(optimum);
  EXPECT_EQ(optimum.error().code, ErrorCode::kNumerical);

  LinearProgram unbounded;
  const auto z = unbounded.AddVariable(-kInfinity, kInfinity, 1);
  unbounded.AddRow({{z, 1}}, -kInfinity, 5);
  optimum = unbounded.Minimize();
  ASSERT_FALSE(optimum);
  EXPECT_EQ(optimum.error().code, ErrorCode::kNumerical);
}

}  // namespace
}  // namespace lowlap
