#include "lowlap/averaging/scales/internal/center_solver.h"

#include <algorithm>
#include <cmath>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/internal/sparse_solver.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/union_find.h"
#include "lowlap/robust/internal/robust_loss.h"

namespace lowlap {
namespace {

using Triplets = std::vector<Eigen::Triplet<double>>;

// Adds the lower triangle of the symmetric block W at (row, column).
void AddBlock(int row, int column, const Mat3& block, Triplets* entries) {
  for (int r = 0; r < 3; ++r) {
    for (int c = 0; c < 3; ++c) {
      if (row + r >= column + c) {
        entries->emplace_back(row + r, column + c, block(r, c));
      }
    }
  }
}

}  // namespace

Result<std::vector<Vec3>> SolveCenters(std::size_t num_views,
                                       const std::vector<CenterEdge>& edges,
                                       const RunContext& context,
                                       int max_iterations) {
  UnionFind sets(num_views);
  for (const CenterEdge& edge : edges) sets.Union(edge.first, edge.second);
  const std::vector<std::size_t> labels = sets.Labels();
  std::vector<int> row(num_views, -1);
  int num_rows = 0;
  std::size_t num_components = 0;
  for (std::size_t n = 0; n < num_views; ++n) {
    if (labels[n] == num_components) {
      ++num_components;
    } else {
      row[n] = num_rows;
      num_rows += 3;
    }
  }
  std::vector<Vec3> centers(num_views, Vec3::Zero());
  if (num_rows == 0) return centers;

  std::vector<Mat3> information;
  information.reserve(edges.size());
  for (const CenterEdge& edge : edges) {
    const Mat3 along =
        edge.direction_in_world * edge.direction_in_world.transpose();
    const double across_size = edge.length * edge.across_rad;
    const double along_size = edge.length * edge.along_log;
    information.push_back((Mat3::Identity() - along) /
                              (across_size * across_size) +
                          along / (along_size * along_size));
  }

  SparseSolver solver(context);
  std::vector<double> robust(edges.size(), 1.0);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    LOWLAP_RETURN_IF_ERROR(AskToGoOn(context, iteration, max_iterations));
    Triplets entries;
    entries.reserve(24 * edges.size());
    Eigen::VectorXd rhs = Eigen::VectorXd::Zero(num_rows);
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const CenterEdge& edge = edges[e];
      const int a = row[edge.first], b = row[edge.second];
      const Mat3 weight = robust[e] * information[e];
      const Vec3 pull = weight * (edge.length * edge.direction_in_world);
      if (a >= 0) {
        AddBlock(a, a, weight, &entries);
        rhs.segment<3>(a) -= pull;
      }
      if (b >= 0) {
        AddBlock(b, b, weight, &entries);
        rhs.segment<3>(b) += pull;
      }
      if (a >= 0 && b >= 0) {
        AddBlock(std::max(a, b), std::min(a, b), -weight, &entries);
      }
    }
    Eigen::SparseMatrix<double> matrix(num_rows, num_rows);
    matrix.setFromTriplets(entries.begin(), entries.end());
    LOWLAP_ASSIGN_OR_RETURN(const auto solution, solver.Solve(matrix, rhs));
    double change = 0, extent = 0;
    for (std::size_t n = 0; n < num_views; ++n) {
      if (row[n] < 0) continue;
      const Vec3 center = solution.block<3, 1>(row[n], 0);
      change = std::max(change, (center - centers[n]).norm());
      extent = std::max(extent, center.norm());
      centers[n] = center;
    }
    if (change <= 1e-5 * extent) break;

    std::vector<double> errors(edges.size());
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const Vec3 residual = centers[edges[e].second] - centers[edges[e].first] -
                            edges[e].length * edges[e].direction_in_world;
      errors[e] =
          std::sqrt(std::max(0.0, residual.dot(information[e] * residual)));
    }
    constexpr double kReach = 3.0;
    const double scale = kReach * std::max(1.0, Median(errors));
    for (std::size_t e = 0; e < edges.size(); ++e) {
      const double x = errors[e] / scale;
      robust[e] = GemanMcClureWeight(x * x);
    }
  }
  return centers;
}

}  // namespace lowlap
