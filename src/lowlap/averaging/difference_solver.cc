#include "lowlap/averaging/internal/difference_solver.h"

#include <algorithm>
#include <numeric>
#include <queue>

#include "lowlap/averaging/internal/sparse_solver.h"
#include "lowlap/core/internal/union_find.h"

namespace lowlap {

Result<Eigen::MatrixXd> SolveDifferences(
    std::size_t num_nodes, const std::vector<DifferenceEdge>& edges,
    const Eigen::VectorXd& weights, const Eigen::MatrixXd& measurements,
    SparseSolver* solver) {
  UnionFind components(num_nodes);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (weights(e) > 0) components.Union(edges[e].first, edges[e].second);
  }
  // Row of each node in the reduced system; the first node of a component has
  // none.
  const std::vector<std::size_t> labels = components.Labels();
  std::vector<int> row(num_nodes, -1);
  int num_rows = 0;
  std::size_t num_components = 0;
  for (std::size_t n = 0; n < num_nodes; ++n) {
    if (labels[n] == num_components) {
      ++num_components;
    } else {
      row[n] = num_rows++;
    }
  }

  Eigen::MatrixXd solution = Eigen::MatrixXd::Zero(
      static_cast<Eigen::Index>(num_nodes), measurements.cols());
  if (num_rows == 0) return solution;

  std::vector<Eigen::Triplet<double>> entries;
  entries.reserve(4 * edges.size());
  Eigen::MatrixXd rhs = Eigen::MatrixXd::Zero(num_rows, measurements.cols());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const double w = weights(e);
    const int a = row[edges[e].first], b = row[edges[e].second];
    if (!(w > 0) || a == b) continue;
    if (a >= 0) {
      entries.emplace_back(a, a, w);
      rhs.row(a) -= w * measurements.row(e);
    }
    if (b >= 0) {
      entries.emplace_back(b, b, w);
      rhs.row(b) += w * measurements.row(e);
    }
    if (a >= 0 && b >= 0) {
      entries.emplace_back(std::max(a, b), std::min(a, b), -w);
    }
  }
  Eigen::SparseMatrix<double> laplacian(num_rows, num_rows);
  laplacian.setFromTriplets(entries.begin(), entries.end());
  SparseSolver own;
  const auto reduced =
      (solver != nullptr ? solver : &own)->Solve(laplacian, rhs);
  if (!reduced) return tl::unexpected<Error>(reduced.error());
  for (std::size_t n = 0; n < num_nodes; ++n) {
    if (row[n] >= 0) solution.row(n) = reduced->row(row[n]);
  }
  return solution;
}

std::vector<ForestStep> MinimumSpanningForest(
    std::size_t num_nodes, const std::vector<DifferenceEdge>& edges,
    const std::vector<double>& costs) {
  std::vector<std::size_t> order(edges.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(
      order.begin(), order.end(),
      [&](std::size_t a, std::size_t b) { return costs[a] < costs[b]; });
  UnionFind components(num_nodes);
  std::vector<std::vector<std::size_t>> incident(num_nodes);
  for (const std::size_t e : order) {
    if (!components.Union(edges[e].first, edges[e].second)) continue;
    incident[edges[e].first].push_back(e);
    incident[edges[e].second].push_back(e);
  }

  std::vector<ForestStep> walk;
  std::vector<bool> visited(num_nodes, false);
  for (std::size_t root = 0; root < num_nodes; ++root) {
    if (visited[root]) continue;
    visited[root] = true;
    std::queue<std::size_t> open({root});
    while (!open.empty()) {
      const std::size_t node = open.front();
      open.pop();
      for (const std::size_t e : incident[node]) {
        const std::size_t other =
            edges[e].first == node ? edges[e].second : edges[e].first;
        if (visited[other]) continue;
        visited[other] = true;
        walk.push_back({e, node, other});
        open.push(other);
      }
    }
  }
  return walk;
}

}  // namespace lowlap
