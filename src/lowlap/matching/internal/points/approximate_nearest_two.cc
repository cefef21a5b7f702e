#include "lowlap/matching/internal/points/approximate_nearest_two.h"

#include <cstddef>
#include <cstdint>
#include <flann/flann.hpp>
#include <mutex>

namespace lowlap {
namespace {

constexpr int kBranching = 32;
constexpr int kTreeIterations = 5;
constexpr int kChecks = 256;  // descriptors that a query is compared with

// A view; FLANN has no const matrix.
flann::Matrix<std::uint8_t> AsMatrix(const std::vector<PointDescriptor>& rows) {
  return {const_cast<std::uint8_t*>(rows.front().data()), rows.size(),
          rows.front().size()};
}

}  // namespace

std::vector<NearestTwo> FindNearestTwoApproximately(
    const std::vector<PointDescriptor>& queries,
    const std::vector<PointDescriptor>& database) {
  if (queries.empty() || database.size() < 2) {
    return FindNearestTwo(queries, database);
  }
  flann::Index<flann::L2<std::uint8_t>> index(
      AsMatrix(database),
      flann::KMeansIndexParams(kBranching, kTreeIterations,
                               flann::FLANN_CENTERS_GONZALES));
  {
    // The first centres are drawn from the process's one stream of random
    // numbers. Its randomised trees, and other centres, have no seed.
    static std::mutex mutex;
    const std::lock_guard<std::mutex> lock(mutex);
    flann::seed_random(0);
    index.buildIndex();
  }
  std::vector<std::size_t> indices(2 * queries.size());
  std::vector<float> distances2(2 * queries.size());
  flann::Matrix<std::size_t> index_rows(indices.data(), queries.size(), 2);
  flann::Matrix<float> distance_rows(distances2.data(), queries.size(), 2);
  index.knnSearch(AsMatrix(queries), index_rows, distance_rows, 2,
                  flann::SearchParams(kChecks));
  // Sums of squares of bytes stay below 2^24: exact in single precision.
  std::vector<NearestTwo> nearest(queries.size());
  for (std::size_t i = 0; i < queries.size(); ++i) {
    nearest[i].index = static_cast<std::int32_t>(indices[2 * i]);
    nearest[i].distance2 = static_cast<std::int32_t>(distances2[2 * i]);
    nearest[i].second_distance2 =
        static_cast<std::int32_t>(distances2[2 * i + 1]);
  }
  return nearest;
}

}  // namespace lowlap
