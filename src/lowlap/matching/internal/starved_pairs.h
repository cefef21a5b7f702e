#pragma once

#include <map>
#include <vector>

#include "lowlap/core/ids.h"
#include "lowlap/matching/internal/matching.h"
#include "lowlap/matching/match_options.h"

namespace lowlap {

/// The pairs whose points are worth matching again from aside: those with fewer
/// than `starved_below` point matches, if one of their views has fewer than
/// `enough_pairs` pairs with more, and they are among the `max_partners` of
/// them in which it has most. In ascending order.
std::vector<ViewPair> SelectStarvedPairs(
    const std::map<ViewPair, PairMatches>& matches,
    const TiltedPointOptions& options);

}  // namespace lowlap
