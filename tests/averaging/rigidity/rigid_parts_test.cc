#include "lowlap/averaging/rigidity/internal/rigid_parts.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

using ViewPairs = std::vector<ViewPair>;
using Labels = std::vector<std::size_t>;

// Labels of the edges after merging, where `joined` are one part from the
// outset.
Labels LabelsOf(const ViewPairs& edges,
                const std::vector<std::vector<std::size_t>>& joined = {}) {
  UnionFind parts(edges.size());
  for (const std::vector<std::size_t>& part : joined) {
    for (const std::size_t e : part) parts.Union(part[0], e);
  }
  MergeRigidParts(edges, &parts);
  return parts.Labels();
}

std::size_t NumParts(const ViewPairs& edges,
                     const std::vector<std::vector<std::size_t>>& joined = {}) {
  const Labels labels = LabelsOf(edges, joined);
  return labels.empty() ? 0
                        : *std::max_element(labels.begin(), labels.end()) + 1;
}

// Views 0, 1, ... each joined with the next two.
ViewPairs Strip(std::uint32_t num_views) {
  ViewPairs edges;
  for (std::uint32_t n = 0; n + 1 < num_views; ++n) {
    edges.push_back({n, n + 1});
    if (n + 2 < num_views) edges.push_back({n, n + 2});
  }
  return edges;
}

TEST(MergeRigidParts, ATriangleIsOnePartAndAPathIsNot) {
  EXPECT_EQ(NumParts({}), 0u);
  EXPECT_EQ(NumParts({{3, 7}}), 1u);
  EXPECT_EQ(NumParts({{0, 1}, {1, 2}}), 2u);
  EXPECT_EQ(NumParts({{0, 1}, {1, 2}, {0, 2}}), 1u);
}

// Two equations close a cycle in the plane, so that all but two of its lengths
// are free.
TEST(MergeRigidParts, LongerCyclesAreNotRigidInAPlane) {
  for (std::uint32_t length = 4; length < 8; ++length) {
    ViewPairs ring;
    for (std::uint32_t n = 0; n < length; ++n) {
      ring.push_back(OrderedPair(n, (n + 1) % length));
    }
    EXPECT_EQ(NumParts(ring), length);
  }
}

TEST(MergeRigidParts, WhatHas2NMinus3EdgesEverywhereIsRigid) {
  // K(3,3) has nine edges and no triangle.
  ViewPairs bipartite;
  for (std::uint32_t a = 0; a < 3; ++a) {
    for (std::uint32_t b = 3; b < 6; ++b) bipartite.push_back({a, b});
  }
  EXPECT_EQ(NumParts(bipartite), 1u);
  // Without one of them it is not.
  bipartite.pop_back();
  EXPECT_EQ(NumParts(bipartite), 8u);
  EXPECT_EQ(NumParts(Strip(12)), 1u);
}

TEST(MergeRigidParts, PartsThatShareTwoViewsAreOne) {
  // Two paths of known lengths from 0 to 3.
  const ViewPairs edges = {{0, 1}, {1, 3}, {0, 2}, {2, 3}};
  EXPECT_EQ(NumParts(edges, {{0, 1}, {2, 3}}), 1u);
  // They share view 3 alone.
  EXPECT_EQ(NumParts({{0, 1}, {1, 3}, {4, 2}, {2, 3}}, {{0, 1}, {2, 3}}), 2u);
}

TEST(MergeRigidParts, ThreePartsInARingAreOneAndFourAreNot) {
  // Parts are paths of two edges, so that no edge closes the ring.
  ViewPairs edges;
  std::vector<std::vector<std::size_t>> parts;
  const auto ring = [&](std::uint32_t size) {
    edges.clear();
    parts.clear();
    for (std::uint32_t n = 0; n < size; ++n) {
      parts.push_back({edges.size(), edges.size() + 1});
      edges.push_back(OrderedPair(2 * n, 2 * n + 1));
      edges.push_back(OrderedPair(2 * n + 1, (2 * n + 2) % (2 * size)));
    }
    return NumParts(edges, parts);
  };
  EXPECT_EQ(ring(3), 1u);
  EXPECT_EQ(ring(4), 4u);
}

TEST(MergeRigidParts, MergesOnlyWithinWhatNoViewSeparates) {
  // Triangles 0-1-2 and 2-3-4, and a square 4-5-6-7 at the end.
  const Labels labels = LabelsOf({{0, 1},
                                  {1, 2},
                                  {0, 2},
                                  {2, 3},
                                  {3, 4},
                                  {2, 4},
                                  {4, 5},
                                  {5, 6},
                                  {6, 7},
                                  {4, 7}});
  EXPECT_EQ(labels, (Labels{0, 0, 0, 1, 1, 1, 2, 3, 4, 5}));
}

TEST(MergeRigidParts, NeverSplitsAPart) {
  EXPECT_EQ(LabelsOf({{0, 1}, {2, 3}, {1, 2}, {3, 4}}, {{0, 2}}),
            (Labels{0, 1, 0, 2}));
}

TEST(MergeRigidParts, DoesNotDependOnTheOrderOfTheEdges) {
  ViewPairs edges = Strip(7);
  edges.insert(edges.end(), {{6, 8}, {8, 9}, {9, 10}, {6, 10}});
  const std::size_t expected = 1 + 4;
  EXPECT_EQ(NumParts(edges), expected);
  for (int turn = 0; turn < 5; ++turn) {
    std::rotate(edges.begin(), edges.begin() + 3, edges.end());
    EXPECT_EQ(NumParts(edges), expected);
  }
}

TEST(MergeRigidParts, LeavesBlocksOfTooManyPartsAsTheyAre) {
  const ViewPairs edges = Strip(128);  // 253 edges
  EXPECT_EQ(NumParts(edges), 253u);
}

}  // namespace
}  // namespace lowlap
