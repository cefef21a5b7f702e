#include "lowlap/averaging/edge_scales.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lowlap/averaging/difference_solver.h"
#include "lowlap/averaging/union_find.h"
#include "lowlap/core/median.h"

namespace lowlap {
namespace {

std::vector<DifferenceEdge> RatioGraph(const TranslationProblem& problem) {
  std::vector<DifferenceEdge> graph;
  graph.reserve(problem.ratios.size());
  for (const RatioMeasurement& ratio : problem.ratios) {
    graph.push_back({ratio.reference, ratio.target});
  }
  return graph;
}

void UpdateResiduals(const TranslationProblem& problem, EdgeScales* scales) {
  scales->normalised_residuals.resize(problem.ratios.size());
  for (std::size_t r = 0; r < problem.ratios.size(); ++r) {
    const RatioMeasurement& ratio = problem.ratios[r];
    scales->normalised_residuals[r] =
        (scales->log_length[ratio.target] -
         scales->log_length[ratio.reference] - ratio.log_ratio) /
        ratio.stddev;
  }
}

}  // namespace

EdgeScales ChainEdgeScales(const TranslationProblem& problem) {
  const std::size_t num_edges = problem.edges.size();
  EdgeScales scales;
  scales.log_length.assign(num_edges, 0.0);
  UnionFind components(num_edges);
  std::vector<double> costs;
  costs.reserve(problem.ratios.size());
  for (const RatioMeasurement& ratio : problem.ratios) {
    components.Union(ratio.reference, ratio.target);
    costs.push_back(ratio.log10_nfa);
  }
  scales.component = components.Labels();
  std::vector<bool> known(num_edges, false);
  for (const std::size_t r :
       MinimumSpanningForest(num_edges, RatioGraph(problem), costs)) {
    const RatioMeasurement& ratio = problem.ratios[r];
    if (!known[ratio.reference] && !known[ratio.target]) {
      known[std::min(ratio.reference, ratio.target)] = true;
    }
    if (known[ratio.reference]) {
      scales.log_length[ratio.target] =
          scales.log_length[ratio.reference] + ratio.log_ratio;
      known[ratio.target] = true;
    } else {
      scales.log_length[ratio.reference] =
          scales.log_length[ratio.target] - ratio.log_ratio;
      known[ratio.reference] = true;
    }
  }
  UpdateResiduals(problem, &scales);
  return scales;
}

Result<EdgeScales> AverageEdgeScales(const TranslationProblem& problem,
                                     int max_iterations) {
  EdgeScales scales = ChainEdgeScales(problem);
  const Eigen::Index count = static_cast<Eigen::Index>(problem.ratios.size());
  if (count == 0) return scales;
  const std::vector<DifferenceEdge> graph = RatioGraph(problem);
  Eigen::MatrixXd measurements(count, 1);
  for (Eigen::Index r = 0; r < count; ++r) {
    measurements(r, 0) = problem.ratios[r].log_ratio;
  }
  Eigen::VectorXd weights(count);
  for (int iteration = 0; iteration < max_iterations; ++iteration) {
    std::vector<double> sizes;
    sizes.reserve(problem.ratios.size());
    for (const double r : scales.normalised_residuals) {
      sizes.push_back(std::abs(r));
    }
    const double scale = std::max(1.0, 1.4826 * Median(std::move(sizes)));
    for (Eigen::Index r = 0; r < count; ++r) {
      constexpr double kReach = 3.0;
      const double x = scales.normalised_residuals[r] / (kReach * scale);
      weights(r) = 1.0 / std::pow(problem.ratios[r].stddev * (1 + x * x), 2);
    }
    const auto solution =
        SolveDifferences(problem.edges.size(), graph, weights, measurements);
    if (!solution) return tl::unexpected<Error>(solution.error());
    double change = 0;
    for (std::size_t e = 0; e < problem.edges.size(); ++e) {
      const double value = (*solution)(static_cast<Eigen::Index>(e), 0);
      change = std::max(change, std::abs(value - scales.log_length[e]));
      scales.log_length[e] = value;
    }
    UpdateResiduals(problem, &scales);
    scales.num_iterations = iteration + 1;
    if (change < 1e-10) break;
  }
  return scales;
}

}  // namespace lowlap
