#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "lowlap/matching/internal/loops/match_loops.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/scene/scene.h"
#include "lowlap/two_view/internal/pair_estimator.h"

namespace lowlap {

/// What loops of matches say of the pairs.
struct LoopFindings {
  /// Of the inliers of all pairs that lead where they should.
  MatchLoops loops;
  /// Pairs whose relative poses stand on matches that lead elsewhere in greater
  /// number than surfaces that end explain (one in ten), by index, and their
  /// putative matches without those.
  std::map<std::size_t, PairMatches> allowed;
};

/// Pairs are looked at in the order of their evidence, with what repeats, so
/// that the stronger ones tell of the weaker; those without evidence of their
/// own take no part. `estimates` has the order of `pairs`. The result refers to
/// the features of the scene.
LoopFindings ExamineLoops(const Scene& scene,
                          const std::vector<ViewPair>& pairs,
                          const std::map<ViewPair, PairMatches>& matches,
                          const std::vector<PairEstimate>& estimates);

/// Those that do not lead elsewhere.
std::vector<FeatureMatch> WithoutContradicted(
    const std::vector<FeatureMatch>& matches,
    const std::vector<LoopVerdict>& verdicts);

}  // namespace lowlap
