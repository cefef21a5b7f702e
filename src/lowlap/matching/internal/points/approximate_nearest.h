#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "lowlap/features/internal/points/point_detector.h"

namespace lowlap {

/// A tree of k-means over descriptors (FLANN; Muja & Lowe, PAMI 2014), which
/// answers in time that hardly grows with their number: some answers are not
/// the nearest. The same for the same descriptors; distances are exact.
class ApproximateIndex {
 public:
  struct Neighbour {
    std::size_t index;
    std::int32_t distance2;  // squared Euclidean
  };

  /// What is spent on it.
  struct Effort {
    int iterations = 5;  // of k-means, on every level of the tree
    int checks = 256;    // descriptors that a query is compared with
  };

  /// `database` is not copied, and not empty.
  ApproximateIndex(const std::vector<PointDescriptor>& database,
                   const Effort& effort);
  ~ApproximateIndex();

  /// Of every query `count` neighbours, nearest first, one query after another.
  /// There must be as many descriptors. May be called by several threads.
  std::vector<Neighbour> Search(const std::vector<PointDescriptor>& queries,
                                std::size_t count) const;

 private:
  struct Tree;
  Effort effort_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace lowlap
