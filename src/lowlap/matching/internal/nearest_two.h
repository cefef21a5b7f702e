#pragma once

#include <cstdint>
#include <vector>

#include "lowlap/features/point_detector.h"

namespace lowlap::internal {

/// The nearest and the second nearest descriptor of a database, by squared
/// Euclidean distance. Equal distances: the lowest index.
struct NearestTwo {
  static constexpr std::int32_t kNone = INT32_MAX;

  std::int32_t index = -1;  // -1: empty database
  std::int32_t distance2 = kNone;
  std::int32_t second_distance2 = kNone;  // kNone: fewer than two
};

/// Exhaustive search. All values are integers below 2^24, which makes single
/// precision arithmetic exact: the result does not depend on the order of
/// summation, hence not on the instruction set.
std::vector<NearestTwo> FindNearestTwo(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database);

}  // namespace lowlap::internal
