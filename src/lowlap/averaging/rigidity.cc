#include "lowlap/averaging/rigidity.h"

#include <Eigen/SVD>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <set>
#include <utility>

#include "lowlap/averaging/union_find.h"
#include "lowlap/core/random.h"

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

// One scale per group; one equation C_b - C_a = s d per edge, in the plane.
// Groups whose scales are proportional over the whole null space are merged.
void MergeByNullSpace(const std::vector<ViewPair>& edges, UnionFind* groups) {
  const std::vector<std::size_t> label = groups->Labels();
  const std::size_t num_groups =
      label.empty() ? 0 : *std::max_element(label.begin(), label.end()) + 1;
  if (num_groups < 3) return;  // fewer cannot close a cycle
  std::map<ViewId, Eigen::Vector2d> centers;
  std::map<ViewId, Eigen::Index> column;
  Random random(20170331);
  for (const ViewPair& edge : edges) {
    for (const ViewId view : {edge.first, edge.second}) {
      if (centers.count(view) > 0) continue;
      column[view] = static_cast<Eigen::Index>(2 * column.size());
      centers[view] = {random.Uniform(-1, 1), random.Uniform(-1, 1)};
    }
  }
  const Eigen::Index scale_offset =
      static_cast<Eigen::Index>(2 * centers.size());
  Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(
      static_cast<Eigen::Index>(2 * edges.size()),
      scale_offset + static_cast<Eigen::Index>(num_groups));
  for (std::size_t e = 0; e < edges.size(); ++e) {
    const Eigen::Index row = static_cast<Eigen::Index>(2 * e);
    const Eigen::Vector2d offset =
        centers[edges[e].second] - centers[edges[e].first];
    for (int axis = 0; axis < 2; ++axis) {
      equations(row + axis, column[edges[e].second] + axis) = 1;
      equations(row + axis, column[edges[e].first] + axis) = -1;
      equations(row + axis,
                scale_offset + static_cast<Eigen::Index>(label[e])) =
          -offset(axis);
    }
  }
  const Eigen::BDCSVD<Eigen::MatrixXd> svd(equations, Eigen::ComputeFullV);
  Eigen::Index rank = 0;
  while (rank < svd.singularValues().size() &&
         svd.singularValues()(rank) > 1e-9 * svd.singularValues()(0)) {
    ++rank;
  }
  const Eigen::MatrixXd scales = svd.matrixV().bottomRightCorner(
      static_cast<Eigen::Index>(num_groups), equations.cols() - rank);
  // The true lengths are scale 1 for every group, so proportional means equal.
  std::vector<std::size_t> edge_of_group(num_groups);
  for (std::size_t e = 0; e < edges.size(); ++e) edge_of_group[label[e]] = e;
  for (std::size_t a = 0; a < num_groups; ++a) {
    for (std::size_t b = a + 1; b < num_groups; ++b) {
      const auto difference = scales.row(static_cast<Eigen::Index>(a)) -
                              scales.row(static_cast<Eigen::Index>(b));
      if (difference.norm() < 1e-7) {
        groups->Union(edge_of_group[a], edge_of_group[b]);
      }
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
    MergeByNullSpace(edges, &sets);
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
