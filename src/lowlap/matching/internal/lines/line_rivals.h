#pragma once

#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// Whether two segments of one view are pieces of one edge: collinear, of one
/// direction, and one behind the other.
bool ArePieces(const LineSegment& a, const LineSegment& b);

struct ScoredMatch {
  FeatureMatch match;
  double score = 0;
};

/// The matches that score at least `min_score` and are clearly better than what
/// contradicts them, the best first (ties by match): no rival has more than
/// `max_rival_share` of the score. A rival shares a segment with the match,
/// with a partner that is no piece of the same edge.
std::vector<FeatureMatch> DecidedMatches(const std::vector<LineSegment>& first,
                                         const std::vector<LineSegment>& second,
                                         std::vector<ScoredMatch> matches,
                                         double min_score,
                                         double max_rival_share);

}  // namespace lowlap
