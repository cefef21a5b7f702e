#pragma once

#include <cstdint>
#include <set>
#include <utility>
#include <vector>

#include "lowlap/core/internal/random.h"

namespace lowlap {

/// Pairs (a < b) of `count` observations: all up to ten observations, else 45
/// of them drawn with a generator of the track's own, so that the result does
/// not depend on the order in which tracks are worked on.
inline std::vector<std::pair<std::size_t, std::size_t>> SamplePairs(
    std::size_t count, std::uint32_t track_id) {
  constexpr std::size_t kMaxPairs = 45;
  std::vector<std::pair<std::size_t, std::size_t>> pairs;
  if (count * (count - 1) / 2 <= kMaxPairs) {
    for (std::size_t a = 0; a < count; ++a) {
      for (std::size_t b = a + 1; b < count; ++b) pairs.emplace_back(a, b);
    }
    return pairs;
  }
  Random random(0, track_id);
  std::set<std::pair<std::size_t, std::size_t>> drawn;
  while (drawn.size() < kMaxPairs) {
    std::size_t a = random.Index(static_cast<std::uint32_t>(count));
    std::size_t b = random.Index(static_cast<std::uint32_t>(count));
    if (a == b) continue;
    if (a > b) std::swap(a, b);
    drawn.emplace(a, b);
  }
  pairs.assign(drawn.begin(), drawn.end());
  return pairs;
}

}  // namespace lowlap
