#pragma once

#include <cstddef>
#include <vector>

namespace lowlap {

/// An arc that wants `from` before `to`; weight >= 0.
struct WeightedArc {
  std::size_t from = 0;
  std::size_t to = 0;
  double weight = 0;
};

/// The place of every vertex in an order that breaks little weight: a greedy
/// answer to the minimum feedback arc set, which is NP-hard. Vertices are laid
/// down one after the other; next is one that no arc of the rest enters, if
/// there is one, else the one with the greatest (out + 1) / (in + 1), weights
/// of the arcs of the rest (after Wilson, Snavely 2014, section 4). Ties: the
/// least index. An acyclic graph is ordered without a broken arc.
/// O(arcs log vertices).
std::vector<std::size_t> OrderVertices(std::size_t num_vertices,
                                       const std::vector<WeightedArc>& arcs);

}  // namespace lowlap
