#include "lowlap/averaging/rigidity.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>
#include <utility>

#include "lowlap/averaging/internal/rigid_parts.h"
#include "lowlap/core/union_find.h"

namespace lowlap {
namespace {

using EdgeIndex = std::map<ViewPair, std::size_t>;

using Triangle = std::array<ViewId, 3>;  // ascending

std::vector<Triangle> FindTriangles(const std::vector<ViewPair>& edges,
                                    const EdgeIndex& index) {
  std::map<ViewId, std::vector<ViewId>> later_neighbours;
  for (const ViewPair& edge : edges) {
    later_neighbours[edge.first].push_back(edge.second);
  }
  std::vector<Triangle> triangles;
  for (const auto& [view, neighbours] : later_neighbours) {
    for (std::size_t a = 0; a < neighbours.size(); ++a) {
      for (std::size_t b = a + 1; b < neighbours.size(); ++b) {
        if (index.count({neighbours[a], neighbours[b]}) > 0) {
          triangles.push_back({view, neighbours[a], neighbours[b]});
        }
      }
    }
  }
  return triangles;
}

void MergeTriangle(const Triangle& t, const EdgeIndex& index,
                   UnionFind* groups) {
  const std::size_t closing = index.at({t[1], t[2]});
  groups->Union(closing, index.at({t[0], t[1]}));
  groups->Union(closing, index.at({t[0], t[2]}));
}

// Number of point tracks that each triangle's three views share.
std::vector<int> SharedTracks(const Scene& scene,
                              const std::vector<Triangle>& triangles) {
  std::map<Triangle, std::size_t> index;
  for (std::size_t n = 0; n < triangles.size(); ++n) index[triangles[n]] = n;
  std::vector<int> counts(triangles.size(), 0);
  for (const auto& [id, track] : scene.point_tracks) {
    for (std::size_t a = 0; a < track.size(); ++a) {
      for (std::size_t b = a + 1; b < track.size(); ++b) {
        for (std::size_t c = b + 1; c < track.size(); ++c) {
          const auto found =
              index.find({track[a].view, track[b].view, track[c].view});
          if (found != index.end()) ++counts[found->second];
        }
      }
    }
  }
  return counts;
}

// The two relative poses of every triplet with a known ratio.
void MergeRatios(const std::vector<ViewTriplet>& ratios, const EdgeIndex& index,
                 UnionFind* groups) {
  const auto find = [&](ViewId a, ViewId b) {
    return index.find({std::min(a, b), std::max(a, b)});
  };
  for (const ViewTriplet& views : ratios) {
    const auto reference = find(views.first, views.middle);
    const auto target = find(views.middle, views.last);
    if (reference != index.end() && target != index.end()) {
      groups->Union(reference->second, target->second);
    }
  }
}

std::vector<std::vector<ViewId>> ConnectedComponents(
    const Scene& scene, const std::vector<ViewPair>& edges,
    std::vector<ViewId>* isolated) {
  std::vector<ViewId> views;
  std::map<ViewId, std::size_t> index;
  for (const auto& entry : scene.views) {
    index[entry.first] = views.size();
    views.push_back(entry.first);
  }
  UnionFind sets(views.size());
  std::set<ViewId> joined;
  for (const ViewPair& edge : edges) {
    sets.Union(index.at(edge.first), index.at(edge.second));
    joined.insert({edge.first, edge.second});
  }
  const std::vector<std::size_t> labels = sets.Labels();
  std::map<std::size_t, std::vector<ViewId>> by_label;
  for (std::size_t n = 0; n < views.size(); ++n) {
    if (joined.count(views[n]) > 0) {
      by_label[labels[n]].push_back(views[n]);
    } else {
      isolated->push_back(views[n]);
    }
  }
  std::vector<std::vector<ViewId>> components;
  for (auto& entry : by_label) components.push_back(std::move(entry.second));
  std::stable_sort(
      components.begin(), components.end(),
      [](const auto& a, const auto& b) { return a.size() > b.size(); });
  return components;
}

// The edges that the rule looks at.
std::vector<ViewPair> RelevantEdges(const Scene& scene,
                                    const RigidityOptions& options,
                                    std::vector<Triangle>* triangles) {
  std::vector<ViewPair> edges;
  EdgeIndex index;
  for (const auto& entry : scene.relative_poses) {
    index[entry.first] = edges.size();
    edges.push_back(entry.first);
  }
  *triangles = FindTriangles(edges, index);
  if (options.rule == RigidityRule::kDirections) return edges;

  const std::vector<int> shared = SharedTracks(scene, *triangles);
  std::vector<Triangle> counted;
  std::set<ViewPair> held;
  for (std::size_t n = 0; n < triangles->size(); ++n) {
    if (shared[n] < options.min_shared_tracks) continue;
    const Triangle& t = (*triangles)[n];
    counted.push_back(t);
    held.insert({{t[0], t[1]}, {t[0], t[2]}, {t[1], t[2]}});
  }
  *triangles = std::move(counted);
  return std::vector<ViewPair>(held.begin(), held.end());
}

}  // namespace

RigidityReport AnalyzeRigidity(const Scene& scene,
                               const RigidityOptions& options) {
  std::vector<Triangle> triangles;
  const std::vector<ViewPair> edges = RelevantEdges(scene, options, &triangles);
  EdgeIndex index;
  for (std::size_t e = 0; e < edges.size(); ++e) index[edges[e]] = e;
  UnionFind sets(edges.size());
  for (const Triangle& triangle : triangles) {
    MergeTriangle(triangle, index, &sets);
  }
  if (options.rule == RigidityRule::kDirections) {
    MergeRatios(options.ratios, index, &sets);
    MergeRigidParts(edges, &sets);
  }

  RigidityReport report;
  report.connected_components =
      ConnectedComponents(scene, edges, &report.isolated_views);
  const std::vector<std::size_t> labels = sets.Labels();
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (labels[e] >= report.groups.size()) {
      report.groups.resize(labels[e] + 1);
    }
    report.groups[labels[e]].edges.push_back(edges[e]);
  }
  for (RigidGroup& group : report.groups) {
    std::set<ViewId> views;
    for (const ViewPair& edge : group.edges) {
      views.insert({edge.first, edge.second});
    }
    group.views.assign(views.begin(), views.end());
  }
  std::stable_sort(report.groups.begin(), report.groups.end(),
                   [](const RigidGroup& a, const RigidGroup& b) {
                     return a.views.size() > b.views.size();
                   });
  std::map<ViewId, std::vector<std::size_t>> groups_of_view;
  for (std::size_t g = 0; g < report.groups.size(); ++g) {
    for (const ViewId view : report.groups[g].views) {
      groups_of_view[view].push_back(g);
    }
  }
  for (auto& [view, groups] : groups_of_view) {
    if (groups.size() > 1) report.hinges.push_back({view, std::move(groups)});
  }
  return report;
}

}  // namespace lowlap
