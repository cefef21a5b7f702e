#include "lowlap/synthetic/internal/pair_graph.h"

#include <algorithm>
#include <charconv>
#include <cstddef>

namespace lowlap {
namespace {

constexpr int kMinSeenTogether = 16;

}  // namespace

Result<PairRule> PairRule::Parse(const std::string& text) {
  PairRule rule;
  if (text == "chain") return rule;
  if (text == "cycle") {
    rule.cycle = true;
    return rule;
  }
  if (text == "all") {
    rule.all = true;
    return rule;
  }
  for (const std::string prefix : {"window:", "loop:"}) {
    if (text.compare(0, prefix.size(), prefix) != 0) continue;
    const char* begin = text.data() + prefix.size();
    const char* end = text.data() + text.size();
    const auto [stop, error] = std::from_chars(begin, end, rule.window);
    if (error != std::errc() || stop != end || rule.window < 1) break;
    rule.loop = prefix == "loop:";
    return rule;
  }
  return MakeError(
      ErrorCode::kInvalidArgument,
      "pairs must be chain, cycle, window:N, loop:N (N >= 1) or all, not '" +
          text + "'");
}

PairGraph::PairGraph(const PairRule& rule, int num_views,
                     const std::map<ViewPair, int>& seen_together)
    : neighbors_(num_views) {
  if (rule.all) {
    for (const auto& [pair, count] : seen_together) {
      if (count >= kMinSeenTogether) pairs_.push_back(pair);
    }
  } else {
    for (int i = 0; i < num_views; ++i) {
      for (int step = 1; step <= rule.window; ++step) {
        const int other = rule.loop ? (i + step) % num_views : i + step;
        if (other >= num_views || other == i) continue;
        pairs_.push_back({static_cast<ViewId>(std::min(i, other)),
                          static_cast<ViewId>(std::max(i, other))});
      }
    }
    if (rule.cycle && num_views > 2) {
      pairs_.push_back({0, static_cast<ViewId>(num_views - 1)});
    }
  }
  std::sort(pairs_.begin(), pairs_.end());
  pairs_.erase(std::unique(pairs_.begin(), pairs_.end()), pairs_.end());
  for (const ViewPair& pair : pairs_) {
    neighbors_[pair.first.value()].push_back(pair.second);
    neighbors_[pair.second.value()].push_back(pair.first);
  }
  for (std::vector<ViewId>& list : neighbors_) {
    std::sort(list.begin(), list.end());
  }
}

bool PairGraph::AreConnected(ViewId a, ViewId b) const {
  return std::binary_search(neighbors_[a.value()].begin(),
                            neighbors_[a.value()].end(), b);
}

std::vector<ViewPair> PairGraph::PairsAmong(
    const std::vector<ViewId>& views) const {
  std::vector<ViewPair> pairs;
  for (std::size_t i = 0; i < views.size(); ++i) {
    for (std::size_t j = i + 1; j < views.size(); ++j) {
      if (AreConnected(views[i], views[j])) {
        pairs.push_back({views[i], views[j]});
      }
    }
  }
  return pairs;
}

std::vector<std::vector<ViewId>> PairGraph::Components(
    const std::vector<ViewId>& views) const {
  std::vector<std::vector<ViewId>> components;
  std::vector<bool> reached(views.size(), false);
  for (std::size_t root = 0; root < views.size(); ++root) {
    if (reached[root]) continue;
    reached[root] = true;
    std::vector<ViewId> component = {views[root]};
    for (std::size_t next = 0; next < component.size(); ++next) {
      for (std::size_t i = root + 1; i < views.size(); ++i) {
        if (reached[i] || !AreConnected(component[next], views[i])) continue;
        reached[i] = true;
        component.push_back(views[i]);
      }
    }
    if (component.size() < 2) continue;
    std::sort(component.begin(), component.end());
    components.push_back(std::move(component));
  }
  return components;
}

}  // namespace lowlap
