#include "lowlap/scale/internal/search/second_mode.h"

#include <algorithm>
#include <cmath>

namespace lowlap {

double HalfSampleMode(const std::vector<double>& sorted) {
  std::size_t begin = 0, size = sorted.size();
  while (size > 2) {
    const std::size_t half = (size + 1) / 2;
    std::size_t best = begin;
    for (std::size_t n = begin; n + half <= begin + size; ++n) {
      if (sorted[n + half - 1] - sorted[n] <
          sorted[best + half - 1] - sorted[best]) {
        best = n;
      }
    }
    begin = best;
    size = half;
  }
  return 0.5 * (sorted[begin] + sorted[begin + size - 1]);
}

std::optional<RatioOptimum> FindSecondMode(const RatioSupport& support,
                                           const RatioNfaCriterion& criterion,
                                           const RatioOptimum& mode) {
  constexpr double kDisagrees = 6.0;
  constexpr std::size_t kFewest = 3;
  std::vector<double> others;
  for (const Hypothesis& hypothesis : support.hypotheses()) {
    if (std::abs(hypothesis.log_ratio - mode.log_ratio) >
        kDisagrees * hypothesis.log_ratio_stddev) {
      others.push_back(hypothesis.log_ratio);
    }
  }
  if (others.size() < kFewest) return std::nullopt;
  SupportWorkspace workspace;
  const auto at = [&](double log_ratio) {
    return RatioOptimum{
        log_ratio,
        criterion.Evaluate(log_ratio, support.Count(log_ratio, &workspace))};
  };
  const RatioOptimum second = at(HalfSampleMode(others));
  if (!(second.nfa.log10_nfa < 0)) return std::nullopt;
  const double pass =
      second.nfa.log10_nfa + std::max(1.0, 0.1 * std::abs(mode.nfa.log10_nfa));
  for (const double share : {0.5, 0.75}) {
    const double between =
        mode.log_ratio + share * (second.log_ratio - mode.log_ratio);
    if (at(between).nfa.log10_nfa >= pass) return second;
  }
  return std::nullopt;
}

}  // namespace lowlap
