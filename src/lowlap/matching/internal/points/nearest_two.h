#pragma once

#include <cstdint>
#include <vector>

#include "lowlap/features/internal/points/point_detector.h"

namespace lowlap {

/// Of the Euclidean distance.
inline std::int32_t SquaredDistance(const PointDescriptor& a,
                                    const PointDescriptor& b) {
  std::int32_t sum = 0;
  for (std::size_t k = 0; k < a.size(); ++k) {
    const std::int32_t difference = static_cast<std::int32_t>(a[k]) - b[k];
    sum += difference * difference;
  }
  return sum;
}

/// The nearest and the second nearest descriptor of a database, by squared
/// Euclidean distance. Equal distances: the lowest index.
struct NearestTwo {
  static constexpr std::int32_t kNone = INT32_MAX;

  std::int32_t index = -1;  // -1: empty database
  std::int32_t distance2 = kNone;
  std::int32_t second_distance2 = kNone;  // kNone: fewer than two
};

/// Exhaustive search, in the faster of the two forms below that the processor
/// has; both are exact, so that the result does not depend on it.
std::vector<NearestTwo> FindNearestTwo(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database);

/// All values are integers below 2^24, which makes single precision arithmetic
/// exact, whatever the order of summation.
std::vector<NearestTwo> FindNearestTwoInFloats(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database);

/// Whether the processor multiplies and sums vectors of bytes (AVX-512 VNNI).
bool HasByteProducts();

/// Needs HasByteProducts().
std::vector<NearestTwo> FindNearestTwoInBytes(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database);

/// FindNearestTwo by an ApproximateIndex of the database.
std::vector<NearestTwo> FindNearestTwoApproximately(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database);

}  // namespace lowlap
