#include "lowlap/averaging/rotations/internal/bridges.h"

#include <algorithm>
#include <limits>

namespace lowlap {
namespace {

constexpr std::size_t kNone = std::numeric_limits<std::size_t>::max();

/// A depth-first forest of the kept edges, with Tarjan's low points: a tree
/// edge is a bridge if nothing below it reaches above it.
struct Forest {
  std::vector<std::size_t> parent_edge;  // kNone for roots
  std::vector<std::size_t> parent;
  std::vector<std::size_t> order;  // position in the walk
  std::vector<std::size_t> last;   // last position in the view's subtree
  std::vector<std::size_t> walk;   // views in the order of the walk
  std::vector<std::size_t> root;
  std::vector<std::size_t> depth;
  std::vector<bool> is_bridge;  // by edge
};

Forest Walk(std::size_t num_views, const std::vector<DifferenceEdge>& edges,
            const std::vector<bool>& kept) {
  std::vector<std::vector<std::size_t>> incident(num_views);
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (!kept[e]) continue;
    incident[edges[e].first].push_back(e);
    incident[edges[e].second].push_back(e);
  }
  Forest forest;
  forest.parent_edge.assign(num_views, kNone);
  forest.parent.assign(num_views, kNone);
  forest.order.assign(num_views, kNone);
  forest.last.assign(num_views, 0);
  forest.root.assign(num_views, 0);
  forest.depth.assign(num_views, 0);
  forest.is_bridge.assign(edges.size(), false);
  std::vector<std::size_t> low(num_views, 0), next(num_views, 0);
  for (std::size_t root = 0; root < num_views; ++root) {
    if (forest.order[root] != kNone) continue;
    std::vector<std::size_t> open = {root};
    const auto enter = [&](std::size_t view) {
      low[view] = forest.order[view] = forest.walk.size();
      forest.root[view] = root;
      forest.walk.push_back(view);
    };
    enter(root);
    while (!open.empty()) {
      const std::size_t view = open.back();
      if (next[view] == incident[view].size()) {
        open.pop_back();
        forest.last[view] = forest.walk.size() - 1;
        if (open.empty()) continue;
        const std::size_t above = open.back();
        low[above] = std::min(low[above], low[view]);
        if (low[view] > forest.order[above]) {
          forest.is_bridge[forest.parent_edge[view]] = true;
        }
        continue;
      }
      const std::size_t e = incident[view][next[view]++];
      if (e == forest.parent_edge[view]) continue;
      const std::size_t other =
          edges[e].first == view ? edges[e].second : edges[e].first;
      if (forest.order[other] == kNone) {
        forest.parent_edge[other] = e;
        forest.parent[other] = view;
        forest.depth[other] = forest.depth[view] + 1;
        enter(other);
        open.push_back(other);
      } else {
        low[view] = std::min(low[view], forest.order[other]);
      }
    }
  }
  return forest;
}

std::vector<std::size_t> BridgesBetween(const Forest& forest, std::size_t a,
                                        std::size_t b) {
  std::vector<std::size_t> from_a, from_b;
  if (forest.root[a] != forest.root[b]) return from_a;
  const auto climb = [&](std::size_t* view, std::vector<std::size_t>* bridges) {
    const std::size_t e = forest.parent_edge[*view];
    if (forest.is_bridge[e]) bridges->push_back(e);
    *view = forest.parent[*view];
  };
  while (a != b) {
    if (forest.depth[a] >= forest.depth[b]) {
      climb(&a, &from_a);
    } else {
      climb(&b, &from_b);
    }
  }
  from_a.insert(from_a.end(), from_b.rbegin(), from_b.rend());
  return from_a;
}

}  // namespace

std::vector<std::vector<std::size_t>> BridgesClosedBy(
    std::size_t num_views, const std::vector<DifferenceEdge>& edges,
    const std::vector<bool>& kept) {
  const Forest forest = Walk(num_views, edges, kept);
  std::vector<std::vector<std::size_t>> closed(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (kept[e]) continue;
    closed[e] = BridgesBetween(forest, edges[e].first, edges[e].second);
  }
  return closed;
}

std::vector<BridgeState> ExamineBridges(
    std::size_t num_views, const std::vector<DifferenceEdge>& edges,
    const std::vector<bool>& kept) {
  const Forest forest = Walk(num_views, edges, kept);
  std::vector<BridgeState> states(edges.size());
  for (std::size_t e = 0; e < edges.size(); ++e) {
    states[e].is_bridge = forest.is_bridge[e];
    if (kept[e]) continue;
    for (const std::size_t bridge :
         BridgesBetween(forest, edges[e].first, edges[e].second)) {
      states[bridge].contradictions.push_back(e);
    }
  }
  for (std::size_t view = 0; view < num_views; ++view) {
    const std::size_t e = forest.parent_edge[view];
    if (e == kNone || states[e].contradictions.empty()) continue;
    // Below the bridge is one interval of the walk; the component is another.
    const std::size_t root = forest.root[view];
    const std::size_t low = forest.order[view], high = forest.last[view];
    const std::size_t all = forest.last[root] - forest.order[root] + 1;
    const bool below_is_smaller = 2 * (high - low + 1) <= all;
    for (std::size_t n = forest.order[root]; n <= forest.last[root]; ++n) {
      const bool is_below = n >= low && n <= high;
      if (is_below == below_is_smaller) {
        states[e].beyond.push_back(forest.walk[n]);
      }
    }
    std::sort(states[e].beyond.begin(), states[e].beyond.end());
  }
  return states;
}

}  // namespace lowlap
