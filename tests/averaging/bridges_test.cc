#include "lowlap/averaging/rotations/internal/bridges.h"

#include <gtest/gtest.h>

namespace lowlap {
namespace {

// Two triangles 0-1-2 and 4-5-6, joined by 2-3 and 3-4; then rejected edges.
std::vector<DifferenceEdge> TwoTriangles() {
  return {{0, 1}, {1, 2}, {2, 0}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 4}};
}

TEST(ExamineBridges, AreTheEdgesOnNoCycle) {
  const auto edges = TwoTriangles();
  const auto states =
      ExamineBridges(7, edges, std::vector<bool>(edges.size(), true));
  for (std::size_t e = 0; e < edges.size(); ++e) {
    EXPECT_EQ(states[e].is_bridge, e == 3 || e == 4) << e;
    EXPECT_TRUE(states[e].contradictions.empty());
    EXPECT_TRUE(states[e].beyond.empty());
  }
}

TEST(ExamineBridges, RejectedEdgesContradictTheBridgesThatTheyCross) {
  auto edges = TwoTriangles();
  edges.push_back({0, 3});  // 8: across 2-3
  edges.push_back({1, 6});  // 9: across both
  edges.push_back({0, 1});  // 10: across none
  std::vector<bool> kept(edges.size(), true);
  kept[8] = kept[9] = kept[10] = false;
  const auto states = ExamineBridges(7, edges, kept);
  EXPECT_EQ(states[3].contradictions, (std::vector<std::size_t>{8, 9}));
  EXPECT_EQ(states[4].contradictions, (std::vector<std::size_t>{9}));
  EXPECT_TRUE(states[0].contradictions.empty());
  EXPECT_EQ(states[3].beyond, (std::vector<std::size_t>{0, 1, 2}));
  EXPECT_EQ(states[4].beyond, (std::vector<std::size_t>{4, 5, 6}));

  const auto closed = BridgesClosedBy(7, edges, kept);
  EXPECT_EQ(closed[8], (std::vector<std::size_t>{3}));
  EXPECT_EQ(closed[9], (std::vector<std::size_t>{3, 4}));
  EXPECT_TRUE(closed[10].empty());
  EXPECT_TRUE(closed[0].empty());
}

TEST(ExamineBridges, ParallelEdgesAreACycle) {
  const std::vector<DifferenceEdge> edges = {{0, 1}, {1, 0}, {1, 2}};
  const auto states = ExamineBridges(3, edges, {true, true, true});
  EXPECT_FALSE(states[0].is_bridge);
  EXPECT_FALSE(states[1].is_bridge);
  EXPECT_TRUE(states[2].is_bridge);
}

TEST(ExamineBridges, RejectedEdgesBetweenComponentsCloseNothing) {
  const std::vector<DifferenceEdge> edges = {{0, 1}, {2, 3}, {1, 2}};
  const std::vector<bool> kept = {true, true, false};
  const auto states = ExamineBridges(4, edges, kept);
  EXPECT_TRUE(states[0].is_bridge);
  EXPECT_TRUE(states[0].contradictions.empty());
  EXPECT_TRUE(BridgesClosedBy(4, edges, kept)[2].empty());
}

}  // namespace
}  // namespace lowlap
