#pragma once

#include <cstddef>
#include <vector>

namespace lowlap {

/// Blocks (biconnected components; Hopcroft and Tarjan 1973) of an undirected
/// graph without parallel edges, given by the neighbours of every node: the
/// largest sets of nodes that stay connected without any one of them, each
/// sorted. A node in two blocks is an articulation point, a block of two nodes
/// a bridge; a node without neighbours is in none. Linear in the graph's size.
std::vector<std::vector<std::size_t>> FindBlocks(
    const std::vector<std::vector<std::size_t>>& neighbors);

}  // namespace lowlap
