#pragma once

#include <algorithm>
#include <map>

#include "lowlap/core/ids.h"

namespace lowlap {

/// What a relative pose or a ratio weighs against others that contradict it:
/// 1 - min(0, log10 NFA).
inline double EvidenceOfNfa(double log10_nfa) {
  return 1 + std::max(0.0, -log10_nfa);
}

/// Relative poses, or ratios, with their evidence, as it counts.
using EvidenceOfPairs = std::map<ViewPair, double>;
using EvidenceOfRatios = std::map<ViewTriplet, double>;

}  // namespace lowlap
