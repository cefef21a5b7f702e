#pragma once

#include <cstddef>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/features/internal/lines/line_descriptor.h"
#include "lowlap/scene/features.h"

namespace lowlap {

/// Numbers of bits in which `query` differs from each of `others`, which
/// replace the content of `distances`.
void HammingDistances(const LineDescriptor& query,
                      const std::vector<LineDescriptor>& others,
                      std::vector<int>* distances);

/// That a neighbouring candidate match speaks for one, and how much.
struct Support {
  std::size_t candidate;
  double weight;
};

/// The scores of candidate matches after `iterations` rounds of relaxation.
/// supports[c] has one list per neighbour of candidate c; its support is the
/// mean over them of
///   max over the list of  weight score(candidate),
/// and its new score support / (support + half_support), in [0, 1). Candidates
/// without neighbours end at zero.
std::vector<double> RelaxScores(
    std::vector<double> scores,
    const std::vector<std::vector<std::vector<Support>>>& supports,
    double half_support, int iterations);

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
