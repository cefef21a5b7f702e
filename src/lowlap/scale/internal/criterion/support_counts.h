#pragma once

#include <array>

#include "lowlap/robust/threshold_ladder.h"

namespace lowlap {

/// Coplanar pairs are tried in nested tiers of proximity: those whose crossing
/// is within 1 % and within 3.5 % of the image diagonal of both segments. Lines
/// that meet in the image are far more often coplanar than others (in the
/// rendered rooms 80 to 90 % of the pairs that nearly touch give the right
/// ratio, 20 % of those more than 100 px apart); pairs that meet farther off
/// are not used: what they agree on by chance, since whole families of them are
/// parallel, is wrong too often. The criterion takes the tier that says most.
inline constexpr int kPairTiers = 2;
inline constexpr std::array<double, kPairTiers> kTierOfDiagonal = {0.01, 0.035};

/// The sizes of a tier, the nearer tiers included.
struct PairTier {
  int num_pairs = 0;
  int num_first = 0;  // lines of (i, j) in at least one pair
  int num_last = 0;   // lines of (j, k)
};

/// Inlier lines by threshold: the error of a line is the least over its
/// partners, so that a pair makes one line of either side an inlier.
struct PairCounts {
  LadderCounts first{};
  LadderCounts last{};
};

/// Inliers of one tau per threshold of the ladder.
struct SupportCounts {
  LadderCounts points{};
  LadderCounts lines{};
  std::array<PairCounts, kPairTiers> coplanar{};
  LadderCounts plane_points{};
};

}  // namespace lowlap
