#pragma once

#include <cstddef>
#include <optional>
#include <set>
#include <vector>

#include "lowlap/averaging/centers/internal/evidence.h"
#include "lowlap/core/ids.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {

/// Cuts of least evidence between two views: maximum flow by shortest
/// augmenting paths (Edmonds and Karp 1972); what the source still reaches is
/// its side of the cut. Every search leaves the one residual graph as it was.
class LeastCut {
 public:
  /// `graph`: of the pairs of `in_use`; must outlive this.
  LeastCut(const ViewGraph& graph, const EvidenceOfPairs& in_use);

  /// The side of `from_view`. Empty if nothing joins the two, or `max_searches`
  /// do not fill all ways.
  std::set<ViewId> SideOf(ViewId from_view, ViewId to_view, int max_searches);

 private:
  struct Arc {
    std::size_t to;
    std::size_t back;  // index of the reverse among the arcs of `to`
    double evidence;
    double residual;
  };

  std::optional<std::size_t> IndexOf(ViewId view) const;
  Arc* Reverse(const Arc& arc) { return &arcs_[arc.to][arc.back]; }
  std::vector<std::size_t> Reach(std::size_t from, std::size_t to);
  void FillWay(std::size_t to);

  const std::vector<ViewId>& views_;
  std::vector<std::vector<Arc>> arcs_;
  std::vector<Arc*> into_;
  std::vector<Arc*> used_;
};

/// Least cuts between views that little joins. Views that more than eight ways
/// without a common pair join hang on none of these.
class WeakCuts {
 public:
  /// As LeastCut.
  WeakCuts(const ViewGraph& graph, const EvidenceOfPairs& in_use);

  /// As LeastCut::SideOf; empty if more than eight ways join the two, too.
  std::set<ViewId> SideOf(ViewId from_view, ViewId to_view);

 private:
  LeastCut ways_, cuts_;
};

/// The views that pairs join to one of the graph, in steps.
std::vector<ViewId> ComponentOf(const ViewGraph& graph, ViewId view);

/// The smaller side of the component that `side` is a part of.
std::vector<ViewId> SmallerSide(const ViewGraph& graph,
                                const std::set<ViewId>& side);

}  // namespace lowlap
