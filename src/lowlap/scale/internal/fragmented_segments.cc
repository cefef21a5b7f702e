#include "lowlap/scale/internal/fragmented_segments.h"

#include <algorithm>
#include <map>
#include <utility>

#include "lowlap/core/internal/union_find.h"

namespace lowlap {
namespace {

// Joins the matches that have a segment in common.
template <class SegmentOf>
void JoinMatches(const std::vector<MiddleMatch>& matches, std::size_t offset,
                 const SegmentOf& segment_of,
                 std::map<FeatureIndex, std::size_t>* match_of,
                 UnionFind* sets) {
  for (std::size_t n = 0; n < matches.size(); ++n) {
    const auto [other, is_new] =
        match_of->emplace(segment_of(matches[n]), offset + n);
    if (!is_new) sets->Union(offset + n, other->second);
  }
}

void SortUnique(std::vector<FeatureIndex>* indices) {
  std::sort(indices->begin(), indices->end());
  indices->erase(std::unique(indices->begin(), indices->end()), indices->end());
}

double SquaredLength(const NormalizedSegment& segment) {
  return (segment.end - segment.start).squaredNorm();
}

}  // namespace

MatchedEdges GroupMatches(const std::vector<MiddleMatch>& ij,
                          const std::vector<MiddleMatch>& jk) {
  const auto middle = [](const MiddleMatch& match) { return match.middle; };
  const auto neighbor = [](const MiddleMatch& match) { return match.neighbor; };
  UnionFind sets(ij.size() + jk.size());
  std::map<FeatureIndex, std::size_t> of_i, of_j, of_k;
  JoinMatches(ij, 0, neighbor, &of_i, &sets);
  JoinMatches(ij, 0, middle, &of_j, &sets);
  JoinMatches(jk, ij.size(), middle, &of_j, &sets);
  JoinMatches(jk, ij.size(), neighbor, &of_k, &sets);

  MatchedEdges matched;
  std::map<std::size_t, int> edge_of_set;
  const auto edge_of = [&](std::size_t match) {
    const auto [edge, is_new] = edge_of_set.emplace(
        sets.Find(match), static_cast<int>(matched.edges.size()));
    if (is_new) matched.edges.emplace_back();
    return edge->second;
  };
  for (std::size_t n = 0; n < ij.size(); ++n) {
    matched.edge_of_ij.push_back(edge_of(n));
    MatchedPieces& edge = matched.edges[matched.edge_of_ij.back()];
    edge.in_i.push_back(ij[n].neighbor);
    edge.in_j.push_back(ij[n].middle);
  }
  for (std::size_t n = 0; n < jk.size(); ++n) {
    matched.edge_of_jk.push_back(edge_of(ij.size() + n));
    MatchedPieces& edge = matched.edges[matched.edge_of_jk.back()];
    edge.in_j.push_back(jk[n].middle);
    edge.in_k.push_back(jk[n].neighbor);
  }
  for (MatchedPieces& edge : matched.edges) {
    SortUnique(&edge.in_i);
    SortUnique(&edge.in_j);
    SortUnique(&edge.in_k);
  }
  return matched;
}

const ObservedSegment& LongestPiece(
    const std::vector<ObservedSegment>& pieces) {
  return *std::max_element(
      pieces.begin(), pieces.end(),
      [](const ObservedSegment& a, const ObservedSegment& b) {
        return SquaredLength(a.segment) < SquaredLength(b.segment);
      });
}

}  // namespace lowlap
