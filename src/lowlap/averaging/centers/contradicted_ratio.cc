#include "lowlap/averaging/centers/internal/contradicted_ratio.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/averaging/internal/problem_errors.h"
#include "lowlap/core/internal/graph_blocks.h"
#include "lowlap/core/internal/propagate.h"

namespace lowlap {
namespace {

double Cost(const TranslationProblem& problem,
            const TranslationSolution& solution) {
  std::vector<double> lengths(problem.edges.size(), 0);  // 0: not placed
  double cost = 0;
  for (std::size_t e = 0; e < problem.edges.size(); ++e) {
    const DirectionEdge& edge = problem.edges[e];
    if (!IsPlaced(solution, edge)) continue;
    lengths[e] = BaselineOf(solution, edge).norm();
    cost += std::log1p(
        std::pow(DirectionErrorRad(solution, edge) / edge.stddev_rad, 2));
  }
  for (const RatioMeasurement& ratio : problem.ratios) {
    const double from = lengths[ratio.reference], to = lengths[ratio.target];
    if (!(from > 0 && to > 0)) continue;
    cost += std::log1p(
        std::pow((std::log(to / from) - ratio.log_ratio) / ratio.stddev, 2));
  }
  return cost;
}

double MinusLogNfa(const RatioMeasurement& ratio) {
  return std::log(10) * std::max(0.0, -ratio.log10_nfa);
}

// Pairs of edges, the lesser first, which one ratio alone ties to each other.
std::set<std::pair<std::size_t, std::size_t>> SoleTies(
    const TranslationProblem& problem) {
  std::vector<std::vector<std::size_t>> tied(problem.edges.size());
  for (const RatioMeasurement& ratio : problem.ratios) {
    tied[ratio.reference].push_back(ratio.target);
    tied[ratio.target].push_back(ratio.reference);
  }
  std::set<std::pair<std::size_t, std::size_t>> ties;
  for (const std::vector<std::size_t>& block : FindBlocks(tied)) {
    if (block.size() == 2) ties.insert(std::minmax(block[0], block[1]));
  }
  return ties;
}

}  // namespace

Result<std::optional<SolutionWithoutRatio>> SolveWithoutContradictedRatio(
    const TranslationProblem& problem, const TranslationAverager& averager,
    const TranslationSolution& solution,
    const std::function<bool(const TranslationSolution&)>& agrees,
    const RunContext& context) {
  constexpr std::size_t kMaxTried = 50;
  double least_cost = Cost(problem, solution);
  const auto sole_ties = SoleTies(problem);
  std::vector<std::size_t> candidates;
  for (std::size_t r = 0; r < problem.ratios.size(); ++r) {
    const RatioMeasurement& ratio = problem.ratios[r];
    if (solution.component[problem.edges[ratio.reference].first] == 0 &&
        sole_ties.count(std::minmax(ratio.reference, ratio.target)) > 0 &&
        MinusLogNfa(ratio) < least_cost) {
      candidates.push_back(r);
    }
  }
  std::stable_sort(
      candidates.begin(), candidates.end(), [&](std::size_t a, std::size_t b) {
        return problem.ratios[a].log10_nfa > problem.ratios[b].log10_nfa;
      });
  candidates.resize(std::min(candidates.size(), kMaxTried));
  std::optional<SolutionWithoutRatio> best;
  TranslationProblem without = problem;
  for (const std::size_t r : candidates) {
    without.ratios = problem.ratios;
    without.ratios.erase(without.ratios.begin() +
                         static_cast<std::ptrdiff_t>(r));
    LOWLAP_ASSIGN_OR_RETURN(auto again, averager.Solve(without, context));
    if (again.NumPlaced() < solution.NumPlaced() || !agrees(again)) continue;
    const double cost = Cost(without, again) + MinusLogNfa(problem.ratios[r]);
    if (cost >= least_cost) continue;
    least_cost = cost;
    best = SolutionWithoutRatio{problem.ratios[r].views, std::move(again)};
  }
  return best;
}

}  // namespace lowlap
