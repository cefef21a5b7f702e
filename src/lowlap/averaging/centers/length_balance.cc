#include "lowlap/averaging/centers/internal/length_balance.h"

#include <algorithm>

#include "lowlap/averaging/centers/internal/contests.h"
#include "lowlap/averaging/internal/problem_errors.h"

namespace lowlap {
namespace {

// A ratio between placed edges: positive if it agrees.
struct WeighedRatio {
  std::size_t edge1 = 0;
  std::size_t edge2 = 0;
  double evidence = 0;
};

std::vector<WeighedRatio> WeighRatios(const TranslationProblem& problem,
                                      const TranslationSolution& solution,
                                      const ErrorLimits& limits) {
  std::vector<WeighedRatio> weighed;
  weighed.reserve(problem.ratios.size());
  for (const RatioMeasurement& ratio : problem.ratios) {
    if (!IsPlaced(solution, problem.edges[ratio.reference]) ||
        !IsPlaced(solution, problem.edges[ratio.target])) {
      continue;
    }
    const double error = LogRatioError(problem, solution, ratio);
    const double evidence = EvidenceOfNfa(ratio.log10_nfa);
    const bool agrees = error <= limits.DirectionRad(0, ratio.stddev);
    weighed.push_back(
        {ratio.reference, ratio.target, agrees ? evidence : -evidence});
  }
  return weighed;
}

std::vector<double> Balance(const std::vector<WeighedRatio>& ratios,
                            const std::vector<char>& is_believed) {
  std::vector<double> balance(is_believed.size(), 0);
  for (const WeighedRatio& ratio : ratios) {
    if (is_believed[ratio.edge1]) balance[ratio.edge2] += ratio.evidence;
    if (is_believed[ratio.edge2]) balance[ratio.edge1] += ratio.evidence;
  }
  return balance;
}

}  // namespace

std::vector<double> LengthBalance(const TranslationProblem& problem,
                                  const TranslationSolution& solution,
                                  const ErrorLimits& limits,
                                  const std::vector<char>& is_believed) {
  return Balance(WeighRatios(problem, solution, limits), is_believed);
}

std::vector<std::size_t> ContradictedLengths(
    const TranslationProblem& problem, const TranslationSolution& solution,
    const ErrorLimits& limits, double sigma_rad) {
  std::vector<char> is_believed;
  is_believed.reserve(problem.edges.size());
  for (const DirectionEdge& edge : problem.edges) {
    is_believed.push_back(IsPlaced(solution, edge) &&
                          DirectionErrorRad(solution, edge) <=
                              limits.DirectionRad(sigma_rad, edge.stddev_rad));
  }
  const std::vector<WeighedRatio> ratios =
      WeighRatios(problem, solution, limits);
  std::vector<std::size_t> contradicted;
  while (true) {
    const std::vector<double> balance = Balance(ratios, is_believed);
    std::size_t worst = balance.size();
    for (std::size_t n = 0; n < balance.size(); ++n) {
      if (is_believed[n] && balance[n] < 0 &&
          (worst == balance.size() || balance[n] < balance[worst])) {
        worst = n;
      }
    }
    if (worst == balance.size()) break;
    is_believed[worst] = 0;
    contradicted.push_back(worst);
  }
  std::sort(contradicted.begin(), contradicted.end());
  return contradicted;
}

}  // namespace lowlap
