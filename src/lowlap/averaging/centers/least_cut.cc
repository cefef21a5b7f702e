#include "lowlap/averaging/centers/internal/least_cut.h"

#include <algorithm>
#include <iterator>
#include <limits>
#include <utility>

namespace lowlap {
namespace {

constexpr int kMaxWays = 8;

EvidenceOfPairs OneEach(EvidenceOfPairs in_use) {
  for (auto& entry : in_use) entry.second = 1;
  return in_use;
}

}  // namespace

LeastCut::LeastCut(const ViewGraph& graph, const EvidenceOfPairs& in_use)
    : views_(graph.views()), arcs_(views_.size()), into_(views_.size()) {
  // Pairs are sorted, and so are the arcs of a view by where they go.
  for (const auto& [pair, evidence] : in_use) {
    const std::size_t first = *IndexOf(pair.first);
    const std::size_t second = *IndexOf(pair.second);
    arcs_[first].push_back({second, arcs_[second].size(), evidence, evidence});
    arcs_[second].push_back(
        {first, arcs_[first].size() - 1, evidence, evidence});
  }
}

std::set<ViewId> LeastCut::SideOf(ViewId from_view, ViewId to_view,
                                  int max_searches) {
  const std::optional<std::size_t> from = IndexOf(from_view);
  const std::optional<std::size_t> to = IndexOf(to_view);
  if (!from || !to) return {};
  std::set<ViewId> side;
  for (int way = 0; way < max_searches; ++way) {
    const std::vector<std::size_t> reached = Reach(*from, *to);
    if (into_[*to] == nullptr) {
      if (way == 0) break;
      for (const std::size_t n : reached) side.insert(views_[n]);
      break;
    }
    FillWay(*to);
  }
  for (Arc* arc : used_) arc->residual = arc->evidence;
  used_.clear();
  return side;
}

std::optional<std::size_t> LeastCut::IndexOf(ViewId view) const {
  const auto found = std::lower_bound(views_.begin(), views_.end(), view);
  if (found == views_.end() || *found != view) return std::nullopt;
  return static_cast<std::size_t>(found - views_.begin());
}

// The views that `from` reaches until `to` is among them, and the arc into
// each but the first.
std::vector<std::size_t> LeastCut::Reach(std::size_t from, std::size_t to) {
  std::fill(into_.begin(), into_.end(), nullptr);
  std::vector<std::size_t> reached = {from};
  for (std::size_t n = 0; n < reached.size() && into_[to] == nullptr; ++n) {
    for (Arc& arc : arcs_[reached[n]]) {
      if (!(arc.residual > 0) || arc.to == from || into_[arc.to] != nullptr) {
        continue;
      }
      into_[arc.to] = &arc;
      reached.push_back(arc.to);
    }
  }
  return reached;
}

// As much as the way that Reach found to `to` still takes.
void LeastCut::FillWay(std::size_t to) {
  std::vector<Arc*> way;
  double flow = std::numeric_limits<double>::infinity();
  for (Arc* arc = into_[to]; arc != nullptr; arc = into_[Reverse(*arc)->to]) {
    way.push_back(arc);
    flow = std::min(flow, arc->residual);
  }
  for (Arc* arc : way) {
    Arc* const reverse = Reverse(*arc);
    arc->residual -= flow;
    reverse->residual += flow;
    used_.insert(used_.end(), {arc, reverse});
  }
}

WeakCuts::WeakCuts(const ViewGraph& graph, const EvidenceOfPairs& in_use)
    : ways_(graph, OneEach(in_use)), cuts_(graph, in_use) {}

std::set<ViewId> WeakCuts::SideOf(ViewId from_view, ViewId to_view) {
  // Every search finds one more way where each pair takes one.
  if (ways_.SideOf(from_view, to_view, kMaxWays + 1).empty()) return {};
  // Evidence may flow over one link from many ways.
  return cuts_.SideOf(from_view, to_view, std::numeric_limits<int>::max());
}

std::vector<ViewId> ComponentOf(const ViewGraph& graph, ViewId view) {
  for (std::vector<ViewId>& component : ConnectedComponents(graph)) {
    if (std::binary_search(component.begin(), component.end(), view)) {
      return std::move(component);
    }
  }
  return {};
}

std::vector<ViewId> SmallerSide(const ViewGraph& graph,
                                const std::set<ViewId>& side) {
  const std::vector<ViewId> component = ComponentOf(graph, *side.begin());
  std::vector<ViewId> other;
  std::set_difference(component.begin(), component.end(), side.begin(),
                      side.end(), std::back_inserter(other));
  if (other.size() < side.size()) return other;
  return {side.begin(), side.end()};
}

}  // namespace lowlap
