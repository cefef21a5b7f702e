#include "lowlap/averaging/rigidity/internal/rigid_parts.h"

#include <Eigen/QR>
#include <algorithm>
#include <cstddef>
#include <map>
#include <set>
#include <utility>

#include "lowlap/core/internal/graph_blocks.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/types.h"

namespace lowlap {
namespace {

constexpr std::size_t kMaxParts = 250;

struct RigidPart {
  std::size_t edge = 0;  // one of its edges
  std::vector<ViewId> views;
};

std::vector<RigidPart> ListParts(const std::vector<ViewPair>& edges,
                                 UnionFind* parts) {
  const std::vector<std::size_t> labels = parts->Labels();
  std::vector<RigidPart> list;
  for (std::size_t e = 0; e < edges.size(); ++e) {
    if (labels[e] >= list.size()) list.resize(labels[e] + 1);
    RigidPart& part = list[labels[e]];
    part.edge = e;
    part.views.push_back(edges[e].first);
    part.views.push_back(edges[e].second);
  }
  for (RigidPart& part : list) {
    std::sort(part.views.begin(), part.views.end());
    part.views.erase(std::unique(part.views.begin(), part.views.end()),
                     part.views.end());
  }
  return list;
}

// The parts that hold each view, for views in two parts or more.
std::map<ViewId, std::vector<std::size_t>> SharedViews(
    const std::vector<RigidPart>& parts) {
  std::map<ViewId, std::vector<std::size_t>> shared;
  for (std::size_t p = 0; p < parts.size(); ++p) {
    for (const ViewId view : parts[p].views) shared[view].push_back(p);
  }
  for (auto it = shared.begin(); it != shared.end();) {
    it = it->second.size() < 2 ? shared.erase(it) : std::next(it);
  }
  return shared;
}

bool MergePartsThatShareTwoViews(const std::vector<RigidPart>& parts,
                                 UnionFind* sets) {
  std::set<std::pair<std::size_t, std::size_t>> met;
  bool merged = false;
  for (const auto& entry : SharedViews(parts)) {
    const std::vector<std::size_t>& around = entry.second;
    for (std::size_t a = 0; a < around.size(); ++a) {
      for (std::size_t b = a + 1; b < around.size(); ++b) {
        if (met.insert({around[a], around[b]}).second) continue;
        merged |= sets->Union(parts[around[a]].edge, parts[around[b]].edge);
      }
    }
  }
  return merged;
}

// Sets of three parts or more that no single view separates: blocks of the
// graph that joins every part to its shared views.
std::vector<std::vector<std::size_t>> BlocksOf(
    const std::vector<RigidPart>& parts) {
  std::vector<std::vector<std::size_t>> neighbors(parts.size());
  for (const auto& entry : SharedViews(parts)) {
    for (const std::size_t p : entry.second) {
      neighbors[p].push_back(neighbors.size());
    }
    neighbors.push_back(entry.second);
  }
  std::vector<std::vector<std::size_t>> blocks = FindBlocks(neighbors);
  for (std::vector<std::size_t>& block : blocks) {
    block.erase(std::lower_bound(block.begin(), block.end(), parts.size()),
                block.end());
  }
  blocks.erase(std::remove_if(blocks.begin(), blocks.end(),
                              [](const auto& b) { return b.size() < 3; }),
               blocks.end());
  return blocks;
}

void MergeByNullSpace(const std::vector<RigidPart>& parts, UnionFind* sets) {
  const Eigen::Index num_parts = static_cast<Eigen::Index>(parts.size());
  const auto shared = SharedViews(parts);
  Eigen::Index num_rows = 0;
  for (const auto& entry : shared) {
    num_rows += 2 * static_cast<Eigen::Index>(entry.second.size());
  }
  // Columns: the scales, then the translations of parts, then the views.
  Eigen::MatrixXd equations = Eigen::MatrixXd::Zero(
      num_rows, 3 * num_parts + 2 * static_cast<Eigen::Index>(shared.size()));
  Random random(20170331);
  Eigen::Index row = 0, view_column = 3 * num_parts;
  for (const auto& entry : shared) {
    // Braces: arguments in parentheses are evaluated in any order.
    const Vec2 center{random.Uniform(-1, 1), random.Uniform(-1, 1)};
    for (const std::size_t p : entry.second) {
      const Eigen::Index part = static_cast<Eigen::Index>(p);
      for (int axis = 0; axis < 2; ++axis, ++row) {
        equations(row, view_column + axis) = 1;
        equations(row, num_parts + 2 * part + axis) = -1;
        equations(row, part) = -center(axis);
      }
    }
    view_column += 2;
  }
  // A basis of the null space: the columns of Q beyond the rank.
  Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr;
  qr.setThreshold(1e-9);
  qr.compute(equations.transpose());
  const Eigen::MatrixXd q = qr.householderQ();
  const Eigen::MatrixXd scales =
      q.topRightCorner(num_parts, equations.cols() - qr.rank());
  // The true scales are 1, so proportional means equal.
  for (Eigen::Index a = 0; a < num_parts; ++a) {
    for (Eigen::Index b = a + 1; b < num_parts; ++b) {
      if ((scales.row(a) - scales.row(b)).norm() < 1e-7) {
        sets->Union(parts[static_cast<std::size_t>(a)].edge,
                    parts[static_cast<std::size_t>(b)].edge);
      }
    }
  }
}

}  // namespace

void MergeRigidParts(const std::vector<ViewPair>& edges, UnionFind* parts) {
  std::vector<RigidPart> list;
  do {
    list = ListParts(edges, parts);
  } while (MergePartsThatShareTwoViews(list, parts));
  for (const std::vector<std::size_t>& block : BlocksOf(list)) {
    if (block.size() > kMaxParts) continue;
    std::vector<RigidPart> members;
    for (const std::size_t p : block) members.push_back(list[p]);
    MergeByNullSpace(members, parts);
  }
}

}  // namespace lowlap
