#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <utility>

namespace lowlap {

/// J^T W J, J^T W r and the cost of a problem of N parameters.
template <int kSize>
struct NormalEquations {
  Eigen::Matrix<double, kSize, kSize> hessian =
      Eigen::Matrix<double, kSize, kSize>::Zero();
  Eigen::Matrix<double, kSize, 1> gradient =
      Eigen::Matrix<double, kSize, 1>::Zero();
  double cost = 0;
};

/// Levenberg-Marquardt with damping relative to the diagonal. A Problem has
/// Linearize(state), which gives NormalEquations; Cost(state); and
/// Moved(state, step). Ends when a step is below 1e-9.
template <class Problem, class State>
State MinimizeLevenbergMarquardt(const Problem& problem, State state,
                                 int max_iterations) {
  double damping = 1e-4;
  auto system = problem.Linearize(state);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    auto damped = system.hessian;
    damped.diagonal() += damping * system.hessian.diagonal();
    const decltype(system.gradient) step =
        -damped.ldlt().solve(system.gradient);
    if (!step.allFinite()) break;
    State moved = problem.Moved(state, step);
    if (problem.Cost(moved) <= system.cost) {
      state = std::move(moved);
      damping = std::max(1e-10, damping * 0.1);
      if (step.norm() < 1e-9) break;
      system = problem.Linearize(state);
    } else {
      if (step.norm() < 1e-9) break;
      damping = std::max(1e-6, damping * 10);
      if (damping > 1e6) break;
    }
  }
  return state;
}

}  // namespace lowlap
