#pragma once

#include <cstddef>
#include <map>
#include <vector>

#include "lowlap/matching/internal/matching.h"
#include "lowlap/scene/scene.h"
#include "lowlap/two_view/internal/pair_estimator.h"

namespace lowlap {

/// Pairs whose relative poses stand on matches that lead elsewhere (MatchLoops)
/// in greater number than surfaces that end explain (one in ten), and their
/// putative matches without those. Pairs are looked at in the order of their
/// evidence, with what repeats, so that the stronger ones tell of the weaker;
/// those without evidence of their own take no part. The keys are indices of
/// `pairs`; `estimates` has their order.
std::map<std::size_t, PairMatches> MatchesThatLoopsAllow(
    const Scene& scene, const std::vector<ViewPair>& pairs,
    const std::map<ViewPair, PairMatches>& matches,
    const std::vector<PairEstimate>& estimates);

}  // namespace lowlap
