#pragma once

#include <map>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {

/// Pairs of a view graph that were kept, and those that were rejected.
struct BridgeReport {
  /// The bridges, kept pairs that are on no cycle of kept pairs, so that
  /// nothing confirms them, with the rejected pairs that join the two sides, in
  /// the order given: each contradicts it.
  std::map<ViewPair, std::vector<ViewPair>> bridges;
  /// By rejected pair that crosses any: the bridges on the path of kept pairs
  /// between its views, from the first view on.
  std::map<ViewPair, std::vector<ViewPair>> crossed;
};

/// Rejected pairs whose views `kept` does not join are passed over. Linear in
/// the size of the graph and in the length of the path that each rejected pair
/// closes.
BridgeReport ExamineBridges(const ViewGraph& kept,
                            const std::vector<ViewPair>& rejected);

/// The views on the smaller side of a bridge (ties: the side without the least
/// id), sorted.
std::vector<ViewId> ViewsBeyond(const ViewGraph& kept, const ViewPair& bridge);

}  // namespace lowlap
