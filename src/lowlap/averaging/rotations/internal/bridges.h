#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/averaging/internal/difference_solver.h"

namespace lowlap {

/// What cycles say about one edge of a graph, some edges of which were
/// rejected.
struct BridgeState {
  /// Kept, and on no cycle of kept edges: nothing confirms it.
  bool is_bridge = false;
  /// Rejected edges that join the two sides of this bridge: each contradicts
  /// it.
  std::vector<std::size_t> contradictions;
  /// The views on the smaller side of a contradicted bridge, sorted.
  std::vector<std::size_t> beyond;
};

/// The bridges of the kept part of a graph; entries of other edges keep their
/// defaults. Linear in the size of the graph, and in the length of the path
/// that each rejected edge closes.
std::vector<BridgeState> ExamineBridges(
    std::size_t num_views, const std::vector<DifferenceEdge>& edges,
    const std::vector<bool>& kept);

/// The bridges on the path of kept edges between the two ends of every rejected
/// edge, from its first view on; empty for kept edges, and where no path of
/// kept edges joins the ends.
std::vector<std::vector<std::size_t>> BridgesClosedBy(
    std::size_t num_views, const std::vector<DifferenceEdge>& edges,
    const std::vector<bool>& kept);

}  // namespace lowlap
