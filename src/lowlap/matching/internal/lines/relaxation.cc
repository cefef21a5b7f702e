#include "lowlap/matching/internal/lines/relaxation.h"

#include <algorithm>
#include <utility>

namespace lowlap {

std::vector<double> RelaxScores(
    std::vector<double> scores,
    const std::vector<std::vector<std::vector<Support>>>& supports,
    double half_support, int iterations) {
  for (int iteration = 0; iteration < iterations; ++iteration) {
    std::vector<double> next(scores.size(), 0);
    for (std::size_t c = 0; c < scores.size(); ++c) {
      if (supports[c].empty()) continue;
      double sum = 0;
      for (const std::vector<Support>& list : supports[c]) {
        double best = 0;
        for (const Support& s : list) {
          best = std::max(best, s.weight * scores[s.candidate]);
        }
        sum += best;
      }
      const double support = sum / static_cast<double>(supports[c].size());
      next[c] = support / (support + half_support);
    }
    scores = std::move(next);
  }
  return scores;
}

}  // namespace lowlap
