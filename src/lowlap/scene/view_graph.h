#pragma once

#include <array>
#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "lowlap/core/ids.h"

namespace lowlap {

struct Scene;

/// The pair in the order in which relative poses are stored, first < second.
ViewPair OrderedPair(ViewId a, ViewId b);

/// Views, and the pairs of them that relative poses join: all that many
/// questions need of a scene. Values are sorted and never repeat.
class ViewGraph {
 public:
  ViewGraph() = default;
  /// The views of `pairs`, in either order, and `views`, which may have no
  /// pair.
  explicit ViewGraph(std::vector<ViewPair> pairs,
                     std::vector<ViewId> views = {});
  /// The views and the relative poses of a scene.
  explicit ViewGraph(const Scene& scene);

  const std::vector<ViewId>& views() const { return views_; }
  const std::vector<ViewPair>& pairs() const { return pairs_; }
  /// Empty for a view that is alone, or not in the graph.
  const std::vector<ViewId>& NeighborsOf(ViewId view) const;
  /// Index into pairs(); nullopt if nothing joins the two.
  std::optional<std::size_t> FindPair(ViewId a, ViewId b) const;

  /// The graph without some of its views and all their pairs, or without some
  /// of its pairs and with all its views. What it does not have is ignored.
  ViewGraph WithoutViews(const std::vector<ViewId>& views) const;
  ViewGraph WithoutPairs(const std::vector<ViewPair>& pairs) const;

 private:
  std::vector<ViewId> views_;
  std::vector<ViewPair> pairs_;
  std::map<ViewId, std::vector<ViewId>> neighbors_;
};

/// Every path i-j-k of two pairs, i < k, sorted.
std::vector<ViewTriplet> FindTriplets(const ViewGraph& graph);

/// The cycles of three views, each ascending, sorted.
std::vector<std::array<ViewId, 3>> FindTriangles(const ViewGraph& graph);

/// Views that pairs join in steps, each set sorted; most views first (ties: by
/// the first view). A view without a pair is a component.
std::vector<std::vector<ViewId>> ConnectedComponents(const ViewGraph& graph);

/// Views without which their component falls apart, sorted.
std::vector<ViewId> ArticulationViews(const ViewGraph& graph);

/// Pairs on no cycle, sorted: without one, its component falls apart.
std::vector<ViewPair> FindBridges(const ViewGraph& graph);

}  // namespace lowlap
