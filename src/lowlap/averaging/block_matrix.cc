#include "lowlap/averaging/internal/block_matrix.h"

#include <algorithm>

namespace lowlap {

// Column 3 b + c of the matrix holds 3 - c entries of the diagonal block, then
// three of every other block of block column b, in the order of places_.
BlockMatrix::BlockMatrix(std::size_t num_blocks, std::vector<Place> places)
    : places_(std::move(places)) {
  for (std::size_t n = 0; n < num_blocks; ++n) places_.push_back({n, n});
  std::sort(places_.begin(), places_.end(), [](const Place& a, const Place& b) {
    return a.second != b.second ? a.second < b.second : a.first < b.first;
  });
  places_.erase(std::unique(places_.begin(), places_.end()), places_.end());
  first_of_column_.assign(num_blocks + 1, 0);
  for (const Place& place : places_) ++first_of_column_[place.second + 1];
  for (std::size_t n = 0; n < num_blocks; ++n) {
    first_of_column_[n + 1] += first_of_column_[n];
  }

  using Index = Eigen::SparseMatrix<double>::StorageIndex;
  const auto size = static_cast<Eigen::Index>(3 * num_blocks);
  lower_.resize(size, size);
  lower_.resizeNonZeros(
      static_cast<Eigen::Index>(9 * places_.size() - 3 * num_blocks));
  Index* outer = lower_.outerIndexPtr();
  Index* inner = lower_.innerIndexPtr();
  Index next = 0;
  for (std::size_t n = 0; n < num_blocks; ++n) {
    for (std::size_t c = 0; c < 3; ++c) {
      outer[3 * n + c] = next;
      for (std::size_t p = first_of_column_[n]; p < first_of_column_[n + 1];
           ++p) {
        const std::size_t row = places_[p].first;
        for (std::size_t r = row == n ? c : 0; r < 3; ++r) {
          inner[next++] = static_cast<Index>(3 * row + r);
        }
      }
    }
  }
  outer[3 * num_blocks] = next;
  SetZero();
}

std::size_t BlockMatrix::FindBlock(std::size_t row, std::size_t column) const {
  const auto begin =
      places_.begin() + static_cast<std::ptrdiff_t>(first_of_column_[column]);
  const auto end = places_.begin() +
                   static_cast<std::ptrdiff_t>(first_of_column_[column + 1]);
  return static_cast<std::size_t>(
      std::lower_bound(begin, end, Place{row, column}) - places_.begin());
}

void BlockMatrix::SetZero() {
  std::fill_n(lower_.valuePtr(), lower_.nonZeros(), 0.0);
}

void BlockMatrix::Add(std::size_t block, const Mat3& value) {
  const auto [row, column] = places_[block];
  const std::size_t before = block - first_of_column_[column];
  for (std::size_t c = 0; c < 3; ++c) {
    double* entries =
        lower_.valuePtr() + lower_.outerIndexPtr()[3 * column + c];
    if (row == column) {
      for (std::size_t r = c; r < 3; ++r) entries[r - c] += value(r, c);
    } else {
      entries += 3 * before - c;
      for (std::size_t r = 0; r < 3; ++r) entries[r] += value(r, c);
    }
  }
}

}  // namespace lowlap
