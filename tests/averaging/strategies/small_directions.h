#pragma once

#include <ceres/ceres.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <utility>
#include <vector>

#include "averaging/random_problem.h"
#include "lowlap/averaging/strategies/internal/bata.h"
#include "lowlap/averaging/strategies/internal/direction_parts.h"
#include "lowlap/robust/internal/robust_loss.h"

namespace lowlap {

/// One part of a problem, and its true centres.
struct SmallDirections {
  RandomProblem made;
  DirectionPart part;
};

inline SmallDirections PartOf(RandomProblem made) {
  SmallDirections small;
  const std::vector<DirectionPart> parts = *FindDirectionParts(made.problem);
  EXPECT_EQ(parts.size(), 1U);
  small.part = parts.at(0);
  EXPECT_EQ(small.part.views.size(), made.centers.size());
  EXPECT_EQ(small.part.edges.size(), made.problem.edges.size());
  small.made = std::move(made);
  return small;
}

/// Ten views and 25 edges without errors.
inline RandomProblem MakeTenViews(std::uint64_t seed) {
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  for (std::size_t n = 0; n < 10; ++n) edges.push_back({n, (n + 1) % 10});
  for (std::size_t n = 0; n < 10; ++n) edges.push_back({n, (n + 2) % 10});
  for (std::size_t n = 0; n < 5; ++n) edges.push_back({n, n + 5});
  RandomProblem made =
      MakeRandomProblem(10, edges, seed, /*with_ratios=*/false);
  for (DirectionEdge& edge : made.problem.edges) edge.stddev_rad = 0.005;
  return made;
}

/// The same with errors of 0.03 rad, two directions quite wrong.
inline SmallDirections MakeNoisyDirections(std::uint64_t seed) {
  RandomProblem made = MakeTenViews(seed);
  Random random(seed + 100);
  std::size_t n = 0;
  for (DirectionEdge& edge : made.problem.edges) {
    const double size = n++ % 12 == 5 ? 0.8 : 0.03;
    edge.direction_in_world =
        (edge.direction_in_world + RandomVector(&random, size)).normalized();
  }
  return PartOf(std::move(made));
}

/// An equilateral triangle of unit sides, walked around; exact.
inline SmallDirections MakeTriangle() {
  RandomProblem made = MakeRandomProblem(
      3,
      std::vector<std::pair<std::size_t, std::size_t>>{{0, 1}, {1, 2}, {2, 0}},
      1, /*with_ratios=*/false);
  made.centers = {{0, 0, 0}, {1, 0, 0}, {0.5, std::sqrt(0.75), 0}};
  for (DirectionEdge& edge : made.problem.edges) {
    edge.direction_in_world =
        (made.centers[edge.second] - made.centers[edge.first]).normalized();
  }
  return PartOf(std::move(made));
}

/// sum rho(e) over the edges, e the sine of the angle between C_j - C_i and d_e
/// up to a right angle, 1 beyond it and for coincident centres; rho Huber's
/// loss, e^2 / 2 up to kAngleHuber.
inline double AngleObjective(const DirectionPart& part,
                             const std::vector<Vec3>& centers) {
  double cost = 0;
  for (const DirectionEdge& edge : part.edges) {
    const Vec3 offset = centers[edge.second] - centers[edge.first];
    const bool is_forward = edge.direction_in_world.dot(offset) > 0;
    const double sine =
        is_forward
            ? edge.direction_in_world.cross(offset).norm() / offset.norm()
            : 1.0;
    cost += HuberLoss(sine, kAngleHuber);
  }
  return cost;
}

/// The final cost of Ceres on a small problem.
inline double SolveWithCeres(ceres::Problem* problem) {
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

/// A host that says stop at the question of this number, the first being 1.
inline RunContext StopAt(int question) {
  RunContext context;
  context.progress = [left = question](const std::string&, std::size_t,
                                       std::size_t) mutable {
    return --left != 0;
  };
  return context;
}

}  // namespace lowlap
