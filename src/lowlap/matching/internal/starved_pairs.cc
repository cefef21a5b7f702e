#include "lowlap/matching/internal/starved_pairs.h"

#include <algorithm>
#include <cstddef>
#include <set>
#include <utility>

namespace lowlap {

std::vector<ViewPair> SelectStarvedPairs(
    const std::map<ViewPair, PairMatches>& matches,
    const TiltedPointOptions& options) {
  struct PairsOfView {
    int num_fed = 0;
    std::vector<std::pair<std::size_t, ViewPair>> starved;  // by matches
  };
  std::map<ViewId, PairsOfView> views;
  for (const auto& [pair, of_pair] : matches) {
    const std::size_t count = of_pair.points.size();
    const bool is_starved =
        count < static_cast<std::size_t>(options.starved_below);
    for (const ViewId view : {pair.first, pair.second}) {
      if (is_starved) {
        views[view].starved.emplace_back(count, pair);
      } else {
        ++views[view].num_fed;
      }
    }
  }
  std::set<ViewPair> selected;
  for (auto& [view, pairs] : views) {
    if (pairs.num_fed >= options.enough_pairs) continue;
    std::stable_sort(
        pairs.starved.begin(), pairs.starved.end(),
        [](const auto& a, const auto& b) { return a.first > b.first; });
    const std::size_t count = std::min(
        pairs.starved.size(), static_cast<std::size_t>(options.max_partners));
    for (std::size_t n = 0; n < count; ++n) {
      selected.insert(pairs.starved[n].second);
    }
  }
  return {selected.begin(), selected.end()};
}

}  // namespace lowlap
