#include "lowlap/matching/internal/points/approximate_nearest.h"

#include <algorithm>
#include <flann/flann.hpp>
#include <mutex>

namespace lowlap {
namespace {

constexpr int kBranching = 32;

// A view; FLANN has no const matrix.
flann::Matrix<std::uint8_t> AsMatrix(const std::vector<PointDescriptor>& rows) {
  return {const_cast<std::uint8_t*>(rows.front().data()), rows.size(),
          rows.front().size()};
}

}  // namespace

struct ApproximateIndex::Tree {
  flann::Index<flann::L2<std::uint8_t>> index;
};

ApproximateIndex::ApproximateIndex(const std::vector<PointDescriptor>& database,
                                   const Effort& effort)
    : effort_(effort),
      tree_(
          new Tree{{AsMatrix(database),
                    flann::KMeansIndexParams(kBranching, effort.iterations,
                                             flann::FLANN_CENTERS_GONZALES)}}) {
  // The first centres are drawn from the process's one stream of random
  // numbers. Its randomised trees, and other centres, have no seed.
  static std::mutex mutex;
  const std::lock_guard<std::mutex> lock(mutex);
  flann::seed_random(0);
  tree_->index.buildIndex();
}

ApproximateIndex::~ApproximateIndex() = default;

std::vector<ApproximateIndex::Neighbour> ApproximateIndex::Search(
    const std::vector<PointDescriptor>& queries, std::size_t count) const {
  if (queries.empty()) return {};
  const std::size_t size = count * queries.size();
  std::vector<std::size_t> indices(size);
  std::vector<float> distances2(size);
  flann::Matrix<std::size_t> index_rows(indices.data(), queries.size(), count);
  flann::Matrix<float> distance_rows(distances2.data(), queries.size(), count);
  flann::SearchParams params(std::max(effort_.checks, static_cast<int>(count)));
  params.cores = 1;
  tree_->index.knnSearch(AsMatrix(queries), index_rows, distance_rows, count,
                         params);
  std::vector<Neighbour> neighbours(size);
  for (std::size_t i = 0; i < size; ++i) {
    // Sums of squares of bytes stay below 2^24: exact in single precision.
    neighbours[i] = {indices[i], static_cast<std::int32_t>(distances2[i])};
  }
  return neighbours;
}

}  // namespace lowlap
