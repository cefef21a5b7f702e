#pragma once

#include <Eigen/SparseCore>
#include <cstddef>
#include <utility>
#include <vector>

#include "lowlap/geometry/types.h"

namespace lowlap {

/// The lower triangle of a symmetric sparse matrix of 3x3 blocks whose pattern
/// is known beforehand and whose values are summed up again and again.
class BlockMatrix {
 public:
  using Place =
      std::pair<std::size_t, std::size_t>;  // row >= column, in blocks

  /// All diagonal blocks, and `places`, which may repeat.
  BlockMatrix(std::size_t num_blocks, std::vector<Place> places);

  /// The number of a block of the pattern.
  std::size_t FindBlock(std::size_t row, std::size_t column) const;
  void SetZero();
  /// Adds to a block; of a diagonal one, the lower triangle.
  void Add(std::size_t block, const Mat3& value);
  const Eigen::SparseMatrix<double>& lower() const { return lower_; }

 private:
  std::vector<Place> places_;  // by column, then row; of each column the
                               // diagonal block comes first
  std::vector<std::size_t> first_of_column_;  // into places_
  Eigen::SparseMatrix<double> lower_;
};

}  // namespace lowlap
