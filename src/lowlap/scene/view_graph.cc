#include "lowlap/scene/view_graph.h"

#include <algorithm>
#include <iterator>
#include <utility>

#include "lowlap/core/internal/graph_blocks.h"
#include "lowlap/core/internal/union_find.h"
#include "lowlap/scene/scene.h"

namespace lowlap {
namespace {

template <class T>
void SortUnique(std::vector<T>* values) {
  std::sort(values->begin(), values->end());
  values->erase(std::unique(values->begin(), values->end()), values->end());
}

// Position in a sorted list that has the value.
std::size_t IndexIn(const std::vector<ViewId>& views, ViewId view) {
  return static_cast<std::size_t>(
      std::lower_bound(views.begin(), views.end(), view) - views.begin());
}

std::vector<std::vector<std::size_t>> Blocks(const ViewGraph& graph) {
  std::vector<std::vector<std::size_t>> neighbors;
  for (const ViewId view : graph.views()) {
    std::vector<std::size_t>& indices = neighbors.emplace_back();
    for (const ViewId neighbor : graph.NeighborsOf(view)) {
      indices.push_back(IndexIn(graph.views(), neighbor));
    }
  }
  return FindBlocks(neighbors);
}

}  // namespace

ViewPair OrderedPair(ViewId a, ViewId b) {
  return {std::min(a, b), std::max(a, b)};
}

ViewGraph::ViewGraph(std::vector<ViewPair> pairs, std::vector<ViewId> views)
    : views_(std::move(views)), pairs_(std::move(pairs)) {
  for (ViewPair& pair : pairs_) {
    pair = OrderedPair(pair.first, pair.second);
    views_.push_back(pair.first);
    views_.push_back(pair.second);
  }
  SortUnique(&views_);
  SortUnique(&pairs_);
  for (const ViewPair& pair : pairs_) {
    neighbors_[pair.first].push_back(pair.second);
    neighbors_[pair.second].push_back(pair.first);
  }
  for (auto& entry : neighbors_) {
    std::sort(entry.second.begin(), entry.second.end());
  }
}

ViewGraph::ViewGraph(const Scene& scene)
    : ViewGraph(
          [&] {
            std::vector<ViewPair> pairs;
            for (const auto& e : scene.relative_poses) pairs.push_back(e.first);
            return pairs;
          }(),
          [&] {
            std::vector<ViewId> views;
            for (const auto& e : scene.views) views.push_back(e.first);
            return views;
          }()) {}

const std::vector<ViewId>& ViewGraph::NeighborsOf(ViewId view) const {
  static const std::vector<ViewId> kNone;
  const auto found = neighbors_.find(view);
  return found == neighbors_.end() ? kNone : found->second;
}

std::optional<std::size_t> ViewGraph::FindPair(ViewId a, ViewId b) const {
  const ViewPair pair = OrderedPair(a, b);
  const auto found = std::lower_bound(pairs_.begin(), pairs_.end(), pair);
  if (found == pairs_.end() || *found != pair) return std::nullopt;
  return static_cast<std::size_t>(found - pairs_.begin());
}

ViewGraph ViewGraph::WithoutViews(const std::vector<ViewId>& views) const {
  const auto is_gone = [gone = ViewGraph({}, views)](ViewId view) {
    return std::binary_search(gone.views().begin(), gone.views().end(), view);
  };
  std::vector<ViewId> kept_views;
  std::remove_copy_if(views_.begin(), views_.end(),
                      std::back_inserter(kept_views), is_gone);
  std::vector<ViewPair> kept;
  std::remove_copy_if(pairs_.begin(), pairs_.end(), std::back_inserter(kept),
                      [&](const ViewPair& pair) {
                        return is_gone(pair.first) || is_gone(pair.second);
                      });
  return ViewGraph(std::move(kept), std::move(kept_views));
}

ViewGraph ViewGraph::WithoutPairs(const std::vector<ViewPair>& pairs) const {
  const ViewGraph gone(pairs);
  std::vector<ViewPair> kept;
  std::set_difference(pairs_.begin(), pairs_.end(), gone.pairs().begin(),
                      gone.pairs().end(), std::back_inserter(kept));
  return ViewGraph(std::move(kept), views_);
}

std::vector<ViewTriplet> FindTriplets(const ViewGraph& graph) {
  std::vector<ViewTriplet> triplets;
  for (const ViewId middle : graph.views()) {
    const std::vector<ViewId>& ends = graph.NeighborsOf(middle);
    for (std::size_t a = 0; a < ends.size(); ++a) {
      for (std::size_t b = a + 1; b < ends.size(); ++b) {
        triplets.push_back({ends[a], middle, ends[b]});
      }
    }
  }
  std::sort(triplets.begin(), triplets.end());
  return triplets;
}

std::vector<std::array<ViewId, 3>> FindTriangles(const ViewGraph& graph) {
  std::vector<std::array<ViewId, 3>> triangles;
  for (const ViewPair& pair : graph.pairs()) {
    const std::vector<ViewId>& of_first = graph.NeighborsOf(pair.first);
    const std::vector<ViewId>& of_second = graph.NeighborsOf(pair.second);
    std::vector<ViewId> shared;
    std::set_intersection(
        std::upper_bound(of_first.begin(), of_first.end(), pair.second),
        of_first.end(),
        std::upper_bound(of_second.begin(), of_second.end(), pair.second),
        of_second.end(), std::back_inserter(shared));
    for (const ViewId third : shared) {
      triangles.push_back({pair.first, pair.second, third});
    }
  }
  return triangles;
}

std::vector<std::vector<ViewId>> ConnectedComponents(const ViewGraph& graph) {
  const std::vector<ViewId>& views = graph.views();
  UnionFind sets(views.size());
  for (const ViewPair& pair : graph.pairs()) {
    sets.Union(IndexIn(views, pair.first), IndexIn(views, pair.second));
  }
  const std::vector<std::size_t> labels = sets.Labels();
  std::vector<std::vector<ViewId>> components;
  for (std::size_t n = 0; n < views.size(); ++n) {
    if (labels[n] >= components.size()) components.resize(labels[n] + 1);
    components[labels[n]].push_back(views[n]);
  }
  std::stable_sort(
      components.begin(), components.end(),
      [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return components;
}

std::vector<ViewId> ArticulationViews(const ViewGraph& graph) {
  std::vector<int> num_blocks(graph.views().size(), 0);
  std::vector<ViewId> views;
  for (const std::vector<std::size_t>& block : Blocks(graph)) {
    for (const std::size_t n : block) {
      if (++num_blocks[n] == 2) views.push_back(graph.views()[n]);
    }
  }
  std::sort(views.begin(), views.end());
  return views;
}

std::vector<ViewPair> FindBridges(const ViewGraph& graph) {
  std::vector<ViewPair> bridges;
  for (const std::vector<std::size_t>& block : Blocks(graph)) {
    if (block.size() != 2) continue;
    bridges.push_back({graph.views()[block[0]], graph.views()[block[1]]});
  }
  std::sort(bridges.begin(), bridges.end());
  return bridges;
}

}  // namespace lowlap
