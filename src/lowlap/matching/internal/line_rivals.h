#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/scene/features.h"

namespace lowlap::internal {

/// Whether two segments of one view are pieces of one edge: collinear, of one
/// direction, and one behind the other.
bool ArePieces(const LineSegment& a, const LineSegment& b);

struct ScoredMatch {
  FeatureMatch match;
  double score = 0;
};

/// For every match the best score of one that contradicts it: that shares a
/// segment with it, with partners that are not pieces of one edge; 0 without
/// such a match. `by_score`: best first.
std::vector<double> FindRivals(const std::vector<LineSegment>& first,
                               const std::vector<LineSegment>& second,
                               const std::vector<ScoredMatch>& by_score);

}  // namespace lowlap::internal
