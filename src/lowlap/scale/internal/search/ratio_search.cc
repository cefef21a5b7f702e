#include "lowlap/scale/internal/search/ratio_search.h"

#include <map>

#include "lowlap/scale/internal/criterion/even_rank.h"

namespace lowlap {
namespace {

// min(wanted, count) numbers of [0, count), evenly spaced; the same read from
// either end.
std::vector<int> EvenlySpaced(int count, int wanted) {
  const int num = std::min(count, wanted);
  std::vector<int> indices;
  indices.reserve(num);
  for (int m = 0; m < num; ++m) {
    indices.push_back(static_cast<int>(EvenRank(m, num, count)));
  }
  return indices;
}

}  // namespace

std::vector<int> CoarseSubset(const std::vector<Hypothesis>& hypotheses) {
  std::vector<int> subset;
  std::map<int, std::vector<int>> by_kind;
  for (std::size_t n = 0; n < hypotheses.size(); ++n) {
    by_kind[hypotheses[n].kind].push_back(static_cast<int>(n));
  }
  for (const auto& [kind, of_kind] : by_kind) {
    for (const int rank :
         EvenlySpaced(static_cast<int>(of_kind.size()), kCoarseHypotheses)) {
      subset.push_back(of_kind[rank]);
    }
  }
  std::sort(subset.begin(), subset.end());
  return subset;
}

std::vector<int> IndicesBetween(int low, int high) {
  std::vector<int> indices;
  for (const int offset :
       EvenlySpaced(std::max(0, high - low - 1), kMaxAroundOne)) {
    indices.push_back(low + 1 + offset);
  }
  return indices;
}

}  // namespace lowlap
