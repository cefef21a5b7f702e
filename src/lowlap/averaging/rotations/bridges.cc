#include "lowlap/averaging/rotations/internal/bridges.h"

#include <algorithm>
#include <set>
#include <utility>

namespace lowlap {
namespace {

/// A spanning forest of the kept pairs. It holds all bridges, so that they are
/// on the way between two views in it if on any.
class Forest {
 public:
  explicit Forest(const ViewGraph& graph) {
    for (const ViewId root : graph.views()) {
      if (!places_.emplace(root, Place{root, root, 0}).second) continue;
      std::vector<ViewId> open = {root};
      for (std::size_t n = 0; n < open.size(); ++n) {
        const ViewId view = open[n];
        const std::size_t depth = places_.at(view).depth + 1;
        for (const ViewId next : graph.NeighborsOf(view)) {
          if (places_.emplace(next, Place{root, view, depth}).second) {
            open.push_back(next);
          }
        }
      }
    }
  }

  /// The pairs on the way from a to b; none if nothing joins them.
  std::vector<ViewPair> Path(ViewId a, ViewId b) const {
    std::vector<ViewPair> from_a, from_b;
    const auto found_a = places_.find(a), found_b = places_.find(b);
    if (found_a == places_.end() || found_b == places_.end() ||
        found_a->second.root != found_b->second.root) {
      return from_a;
    }
    const auto climb = [&](ViewId* view, std::vector<ViewPair>* path) {
      const ViewId parent = places_.at(*view).parent;
      path->push_back(OrderedPair(*view, parent));
      *view = parent;
    };
    while (a != b) {
      if (places_.at(a).depth >= places_.at(b).depth) {
        climb(&a, &from_a);
      } else {
        climb(&b, &from_b);
      }
    }
    from_a.insert(from_a.end(), from_b.rbegin(), from_b.rend());
    return from_a;
  }

 private:
  struct Place {
    ViewId root, parent;
    std::size_t depth;
  };
  std::map<ViewId, Place> places_;
};

// The views that `start` reaches without the bridge, sorted.
std::vector<ViewId> SideOf(const ViewGraph& graph, const ViewPair& bridge,
                           ViewId start) {
  std::set<ViewId> reached = {start};
  std::vector<ViewId> open = {start};
  for (std::size_t n = 0; n < open.size(); ++n) {
    for (const ViewId next : graph.NeighborsOf(open[n])) {
      if (OrderedPair(open[n], next) == bridge) continue;
      if (reached.insert(next).second) open.push_back(next);
    }
  }
  return {reached.begin(), reached.end()};
}

}  // namespace

BridgeReport ExamineBridges(const ViewGraph& kept,
                            const std::vector<ViewPair>& rejected) {
  BridgeReport report;
  for (const ViewPair& bridge : FindBridges(kept)) report.bridges[bridge];
  const Forest forest(kept);
  for (const ViewPair& pair : rejected) {
    for (const ViewPair& step : forest.Path(pair.first, pair.second)) {
      const auto bridge = report.bridges.find(step);
      if (bridge == report.bridges.end()) continue;
      bridge->second.push_back(pair);
      report.crossed[pair].push_back(step);
    }
  }
  return report;
}

std::vector<ViewId> ViewsBeyond(const ViewGraph& kept, const ViewPair& bridge) {
  std::vector<ViewId> first = SideOf(kept, bridge, bridge.first);
  std::vector<ViewId> second = SideOf(kept, bridge, bridge.second);
  const bool second_is_smaller =
      second.size() < first.size() ||
      (second.size() == first.size() && first.front() < second.front());
  return second_is_smaller ? second : first;
}

}  // namespace lowlap
