#pragma once

#include <algorithm>
#include <vector>

#include "lowlap/scale/internal/criterion/ratio_support.h"

namespace lowlap {

/// Hypotheses of each kind that a large triplet tries first.
inline constexpr int kCoarseHypotheses = 64;
/// Best ones of them whose surroundings are then tried.
inline constexpr int kRefinedHypotheses = 4;
/// Most hypotheses tried around one of them (evenly spaced if there are more).
inline constexpr int kMaxAroundOne = 48;

/// Indices of the hypotheses to try first, sorted: up to kCoarseHypotheses of
/// each kind, evenly spaced in the order of their log ratios.
std::vector<int> CoarseSubset(const std::vector<Hypothesis>& hypotheses);

/// Up to kMaxAroundOne indices, evenly spaced strictly between two.
std::vector<int> IndicesBetween(int low, int high);

/// Tries hypotheses, which are sorted by log ratio, and returns the index of
/// the best; there must be one. `score(index)` returns a type with
/// BetterThan(); ties go to the smaller standard deviation, then to the lower
/// log ratio.
///
/// With `exhaustive` every hypothesis is tried (the reference). Otherwise
/// CoarseSubset, then those between a coarse one and its coarse neighbours, for
/// the kRefinedHypotheses best. A mode is sure to be probed if it holds more
/// than one in kCoarseHypotheses of the hypotheses of some kind; a smaller one
/// may be missed. With few hypotheses both are the same.
template <class ScoreFunction>
int SearchRatios(const std::vector<Hypothesis>& hypotheses, bool exhaustive,
                 const ScoreFunction& score) {
  using Score = decltype(score(0));
  struct Tried {
    int index;
    Score score;
  };
  const auto better = [&](const Tried& a, const Tried& b) {
    if (a.score.BetterThan(b.score)) return true;
    if (b.score.BetterThan(a.score)) return false;
    const double stddev_a = hypotheses[a.index].log_ratio_stddev;
    const double stddev_b = hypotheses[b.index].log_ratio_stddev;
    return stddev_a != stddev_b ? stddev_a < stddev_b : a.index < b.index;
  };
  const int num_hypotheses = static_cast<int>(hypotheses.size());
  std::vector<int> coarse;
  if (exhaustive) {
    for (int n = 0; n < num_hypotheses; ++n) coarse.push_back(n);
  } else {
    coarse = CoarseSubset(hypotheses);
  }
  std::vector<Tried> tried;
  tried.reserve(coarse.size());
  for (const int index : coarse) tried.push_back({index, score(index)});
  const std::size_t num_best =
      std::min<std::size_t>(kRefinedHypotheses, tried.size());
  std::partial_sort(tried.begin(), tried.begin() + num_best, tried.end(),
                    better);
  Tried best = tried.front();
  if (static_cast<int>(coarse.size()) == num_hypotheses) return best.index;

  std::vector<int> fine;
  for (std::size_t n = 0; n < num_best; ++n) {
    const auto at =
        std::lower_bound(coarse.begin(), coarse.end(), tried[n].index);
    const int low = at == coarse.begin() ? -1 : *(at - 1);
    const int high = at + 1 == coarse.end() ? num_hypotheses : *(at + 1);
    for (const int index : IndicesBetween(low, high)) fine.push_back(index);
  }
  std::sort(fine.begin(), fine.end());
  fine.erase(std::unique(fine.begin(), fine.end()), fine.end());
  for (const int index : fine) {
    const Tried next{index, score(index)};
    if (better(next, best)) best = next;
  }
  return best.index;
}

}  // namespace lowlap
