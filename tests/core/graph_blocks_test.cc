#include "lowlap/core/internal/graph_blocks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <utility>

#include "lowlap/core/internal/random.h"
#include "lowlap/core/internal/union_find.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::UnorderedElementsAre;

using Edges = std::vector<std::pair<std::size_t, std::size_t>>;

std::vector<std::vector<std::size_t>> Blocks(std::size_t num_nodes,
                                             const Edges& edges) {
  std::vector<std::vector<std::size_t>> neighbors(num_nodes);
  for (const auto& [a, b] : edges) {
    neighbors[a].push_back(b);
    neighbors[b].push_back(a);
  }
  return FindBlocks(neighbors);
}

TEST(FindBlocks, ACycleIsOneAndABridgeIsOne) {
  EXPECT_THAT(Blocks(6, {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4}}),
              UnorderedElementsAre(ElementsAre(0, 1, 2), ElementsAre(2, 3),
                                   ElementsAre(3, 4)));
}

TEST(FindBlocks, CyclesThatMeetInANodeAreTwo) {
  EXPECT_THAT(Blocks(5, {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4}, {4, 2}}),
              UnorderedElementsAre(ElementsAre(0, 1, 2), ElementsAre(2, 3, 4)));
}

TEST(FindBlocks, NoEdgeNoBlock) {
  EXPECT_THAT(Blocks(3, {}), IsEmpty());
  EXPECT_THAT(FindBlocks({}), IsEmpty());
}

std::size_t NumComponents(std::size_t num_nodes, const Edges& edges,
                          std::size_t without) {
  UnionFind sets(num_nodes);
  for (const auto& [a, b] : edges) {
    if (a != without && b != without) sets.Union(a, b);
  }
  const auto labels = sets.Labels();
  return labels.empty() ? 0 : *std::max_element(labels.begin(), labels.end());
}

// By the definition: taking the node away leaves more components than there
// were. Taken away it counts as one more itself.
TEST(FindBlocks, NodesInTwoBlocksSeparateRandomGraphs) {
  constexpr std::size_t kNodes = 12;
  for (std::uint64_t trial = 0; trial < 200; ++trial) {
    Random random(trial);
    const double density = random.Uniform(0.1, 0.3);
    Edges edges;
    for (std::size_t a = 0; a < kNodes; ++a) {
      for (std::size_t b = a + 1; b < kNodes; ++b) {
        if (random.Uniform() < density) edges.push_back({a, b});
      }
    }
    std::vector<int> num_blocks(kNodes, 0), degree(kNodes, 0);
    for (const auto& block : Blocks(kNodes, edges)) {
      for (const std::size_t n : block) ++num_blocks[n];
    }
    for (const auto& [a, b] : edges) {
      ++degree[a];
      ++degree[b];
    }
    const std::size_t all = NumComponents(kNodes, edges, kNodes);
    for (std::size_t n = 0; n < kNodes; ++n) {
      EXPECT_EQ(num_blocks[n] > 0, degree[n] > 0);
      EXPECT_EQ(num_blocks[n] > 1,
                degree[n] > 0 && NumComponents(kNodes, edges, n) > all + 1)
          << trial << " " << n;
    }
  }
}

}  // namespace
}  // namespace lowlap
