#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <vector>

#include "lowlap/core/result.h"

namespace lowlap {

class SparseSolver;

/// One measured difference x_second - x_first on a graph.
struct DifferenceEdge {
  std::size_t first = 0;
  std::size_t second = 0;
};

/// argmin over x of sum_e w_e |x_second(e) - x_first(e) - m_e|^2.
///
/// The weighted graph Laplacian that rotation averaging (tangent vectors) and
/// scale averaging (log lengths) share. `measurements` is E x D, the result
/// N x D. Gauge: the first node of every connected component is 0. Edges of
/// weight 0 do not connect. kNumerical if the factorisation fails. A `solver`
/// that is given keeps what it found out about the graph for the next call.
Result<Eigen::MatrixXd> SolveDifferences(
    std::size_t num_nodes, const std::vector<DifferenceEdge>& edges,
    const Eigen::VectorXd& weights, const Eigen::MatrixXd& measurements,
    SparseSolver* solver = nullptr);

/// One edge of a forest, walked away from the root.
struct ForestStep {
  std::size_t edge = 0;
  std::size_t from = 0;
  std::size_t to = 0;
};

/// The spanning forest that prefers edges of low cost (Kruskal; ties by index),
/// in the order in which a walk from the first node of every component meets
/// its edges: no step goes to that node, and one goes to each other node,
/// before any goes from there.
std::vector<ForestStep> MinimumSpanningForest(
    std::size_t num_nodes, const std::vector<DifferenceEdge>& edges,
    const std::vector<double>& costs);

}  // namespace lowlap
