#pragma once

#include <cstdint>
#include <cstring>

#include "lowlap/features/line_descriptor.h"

namespace lowlap::internal {

inline int HammingDistance(const LineDescriptor& a, const LineDescriptor& b) {
  int distance = 0;
  for (std::size_t at = 0; at < a.size(); at += sizeof(std::uint64_t)) {
    std::uint64_t x = 0, y = 0;
    std::memcpy(&x, a.data() + at, sizeof(x));
    std::memcpy(&y, b.data() + at, sizeof(y));
    distance += __builtin_popcountll(x ^ y);
  }
  return distance;
}

}  // namespace lowlap::internal
