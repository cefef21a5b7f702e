#pragma once

#include <cstddef>
#include <vector>

namespace lowlap {

/// Disjoint sets over 0..n-1, with path halving and union by size.
class UnionFind {
 public:
  explicit UnionFind(std::size_t count);

  std::size_t Find(std::size_t element);
  /// False if both were in one set already.
  bool Union(std::size_t a, std::size_t b);

  /// One label per element, 0, 1, ... in the order of first appearance.
  std::vector<std::size_t> Labels();

 private:
  std::vector<std::size_t> parent_;
  std::vector<std::size_t> size_;
};

}  // namespace lowlap
