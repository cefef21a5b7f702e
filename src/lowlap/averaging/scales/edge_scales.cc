#include "lowlap/averaging/scales/internal/edge_scales.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "lowlap/averaging/internal/cancellation.h"
#include "lowlap/averaging/internal/difference_solver.h"
#include "lowlap/averaging/internal/sparse_solver.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/core/internal/union_find.h"
#include "lowlap/robust/internal/median_deviation.h"
#include "lowlap/robust/internal/robust_loss.h"

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

// What a start is judged by. Evidence weighs, but only with its logarithm.
double ScaleCost(const TranslationProblem& problem, const EdgeScales& scales) {
  double cost = 0;
  for (std::size_t r = 0; r < problem.ratios.size(); ++r) {
    const double residual = scales.normalised_residuals[r];
    cost += (1 + std::log1p(std::max(0.0, -problem.ratios[r].log10_nfa))) *
            std::log1p(residual * residual);
  }
  return cost;
}

enum class ScaleLoss { kAbsolute, kGemanMcClure };

/// Reweighted least squares on one problem.
class Averaging {
 public:
  Averaging(const TranslationProblem& problem, const RunContext& context)
      : problem_(problem),
        context_(context),
        graph_(RatioGraph(problem)),
        solver_(context) {
    const auto count = static_cast<Eigen::Index>(problem.ratios.size());
    measurements_.resize(count, 1);
    weights_.resize(count);
    for (Eigen::Index r = 0; r < count; ++r) {
      measurements_(r, 0) = problem.ratios[r].log_ratio;
    }
  }

  /// Goes on from `scales` until no length changes.
  Status Run(ScaleLoss loss, int max_iterations, EdgeScales* scales) {
    // The absolute residuals only serve as a start.
    const double tolerance = loss == ScaleLoss::kAbsolute ? 1e-3 : 1e-11;
    for (int iteration = 0; iteration < max_iterations; ++iteration) {
      LOWLAP_RETURN_IF_ERROR(AskToGoOn(context_, iteration, max_iterations));
      SetWeights(loss, scales->normalised_residuals);
      const auto solution = SolveDifferences(problem_.edges.size(), graph_,
                                             weights_, measurements_, &solver_);
      if (!solution) return tl::unexpected<Error>(solution.error());
      double change = 0;
      for (std::size_t e = 0; e < problem_.edges.size(); ++e) {
        const double value = (*solution)(static_cast<Eigen::Index>(e), 0);
        change = std::max(change, std::abs(value - scales->log_length[e]));
        scales->log_length[e] = value;
      }
      UpdateResiduals(problem_, scales);
      ++scales->num_iterations;
      if (change < tolerance) break;
    }
    return {};
  }

 private:
  void SetWeights(ScaleLoss loss, const std::vector<double>& residuals) {
    std::vector<double> sizes;
    sizes.reserve(residuals.size());
    for (const double r : residuals) sizes.push_back(std::abs(r));
    const double scale =
        std::max(1.0, Median(std::move(sizes)) / kMedianOfNorm<1>);
    for (Eigen::Index r = 0; r < weights_.size(); ++r) {
      const double x = std::abs(residuals[r]) / scale;
      double factor = 0;
      if (loss == ScaleLoss::kAbsolute) {
        factor = 1 / std::max(x, 0.1);
      } else {
        constexpr double kReach = 3.0;
        factor = GemanMcClureWeight(x * x / (kReach * kReach));
      }
      weights_(r) = factor / std::pow(problem_.ratios[r].stddev, 2);
    }
  }

  const TranslationProblem& problem_;
  const RunContext& context_;
  std::vector<DifferenceEdge> graph_;
  Eigen::MatrixXd measurements_;
  Eigen::VectorXd weights_;
  SparseSolver solver_;
};

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
  for (const ForestStep& step :
       MinimumSpanningForest(num_edges, RatioGraph(problem), costs)) {
    const RatioMeasurement& ratio = problem.ratios[step.edge];
    scales.log_length[step.to] =
        scales.log_length[step.from] +
        (step.from == ratio.reference ? ratio.log_ratio : -ratio.log_ratio);
  }
  UpdateResiduals(problem, &scales);
  return scales;
}

Result<EdgeScales> AverageEdgeScales(const TranslationProblem& problem,
                                     const RunContext& context,
                                     int max_iterations) {
  // L1 reweighting gets near soon, and then goes on for long.
  constexpr int kL1Iterations = 15;
  // No spanning forest of so many ratios is free of false ones.
  constexpr std::size_t kMaxRatiosOfChainStart = 10'000;

  EdgeScales from_chain = ChainEdgeScales(problem);
  if (problem.ratios.empty()) return from_chain;
  Averaging averaging(problem, context);
  EdgeScales from_l1 = from_chain;
  LOWLAP_RETURN_IF_ERROR(
      averaging.Run(ScaleLoss::kAbsolute, kL1Iterations, &from_l1));
  LOWLAP_RETURN_IF_ERROR(
      averaging.Run(ScaleLoss::kGemanMcClure, max_iterations, &from_l1));
  if (problem.ratios.size() > kMaxRatiosOfChainStart) return from_l1;
  LOWLAP_RETURN_IF_ERROR(
      averaging.Run(ScaleLoss::kGemanMcClure, max_iterations, &from_chain));
  const double chain_cost = ScaleCost(problem, from_chain);
  const double l1_cost = ScaleCost(problem, from_l1);
  return l1_cost < chain_cost - 1e-6 * (1 + chain_cost) ? from_l1 : from_chain;
}

}  // namespace lowlap
