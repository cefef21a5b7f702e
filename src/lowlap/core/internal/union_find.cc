#include "lowlap/core/internal/union_find.h"

#include <limits>
#include <numeric>
#include <utility>

namespace lowlap {

UnionFind::UnionFind(std::size_t count) : parent_(count), size_(count, 1) {
  std::iota(parent_.begin(), parent_.end(), std::size_t{0});
}

std::size_t UnionFind::Find(std::size_t element) {
  while (parent_[element] != element) {
    parent_[element] = parent_[parent_[element]];
    element = parent_[element];
  }
  return element;
}

bool UnionFind::Union(std::size_t a, std::size_t b) {
  a = Find(a);
  b = Find(b);
  if (a == b) return false;
  if (size_[a] < size_[b]) std::swap(a, b);
  parent_[b] = a;
  size_[a] += size_[b];
  return true;
}

std::vector<std::size_t> UnionFind::Labels() {
  constexpr std::size_t kUnlabeled = std::numeric_limits<std::size_t>::max();
  std::vector<std::size_t> label_of_root(parent_.size(), kUnlabeled);
  std::vector<std::size_t> labels(parent_.size());
  std::size_t next = 0;
  for (std::size_t n = 0; n < parent_.size(); ++n) {
    std::size_t& label = label_of_root[Find(n)];
    if (label == kUnlabeled) label = next++;
    labels[n] = label;
  }
  return labels;
}

}  // namespace lowlap
