#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/scale/triplet_view.h"

namespace lowlap {

/// A match seen from the middle view.
struct MiddleMatch {
  FeatureIndex middle = 0;
  FeatureIndex neighbor = 0;
};

/// Segments of the three views that show one edge, as pieces where a view
/// breaks it; sorted.
struct MatchedPieces {
  std::vector<FeatureIndex> in_i;
  std::vector<FeatureIndex> in_j;
  std::vector<FeatureIndex> in_k;
};

/// The line matches of a triplet by edge. A broken segment has a match for
/// every piece; these are one edge and say what one line says, not more.
struct MatchedEdges {
  std::vector<MatchedPieces> edges;
  std::vector<int> edge_of_ij;  // of every match of (i, j)
  std::vector<int> edge_of_jk;
};

/// Matches that share a segment, directly or through others, are one edge.
/// The edges are in the order in which the matches first name them.
MatchedEdges GroupMatches(const std::vector<MiddleMatch>& ij,
                          const std::vector<MiddleMatch>& jk);

/// The longest of the pieces of one view, which must not be empty; it stands
/// for the edge. (A segment through all pieces is longer, but no better: pieces
/// are matched to an edge by mistake often enough. Measured on coplanar pairs.)
const ObservedSegment& LongestPiece(const std::vector<ObservedSegment>& pieces);

}  // namespace lowlap
