#include "lowlap/averaging/rigidity.h"

#include <Eigen/SVD>
#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "lowlap/averaging/union_find.h"
#include "lowlap/core/random.h"

namespace lowlap {
namespace {

using EdgeIndex = std::map<ViewPair, std::size_t>;

// Joins the three edges of every triangle.
void MergeTriangles(const std::vector<ViewPair>& edges, const EdgeIndex& index,
                    UnionFind* groups) {
  std::map<ViewId, std::vector<ViewId>> later_neighbours;
  for (const ViewPair& edge : edges) {
    later_neighbours[edge.first].push_back(edge.second);
  }
  for (const auto& [view, neighbours] : later_neighbours) {
    for (std::size_t a = 0; a < neighbours.size(); ++a) {
      for (std::size_t b = a + 1; b < neighbours.size(); ++b) {
        const auto closing =
            index.find({std::min(neighbours[a], neighbours[b]),
                        std::max(neighbours[a], neighbours[b])});
        if (closing == index.end()) continue;
        groups->Union(closing->second, index.at({view, neighbours[a]}));
        groups->Union(closing->second, index.at({view, neighbours[b]}));
      }
    }
  }
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

}  // namespace

RigidityReport AnalyzeRigidity(const Scene& scene) {
  std::vector<ViewPair> edges;
  EdgeIndex index;
  for (const auto& entry : scene.relative_poses) {
    index[entry.first] = edges.size();
    edges.push_back(entry.first);
  }
  UnionFind sets(edges.size());
  MergeTriangles(edges, index, &sets);
  MergeByNullSpace(edges, &sets);

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
