#include "lowlap/scene/view_graph.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lowlap/scene/scene.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

ViewGraph Graph(const std::vector<ViewPair>& pairs) { return ViewGraph(pairs); }

// Two triangles 1-2-5 and 6-7-9 that 5-6 joins, 20-21, and 30 alone.
ViewGraph Example() {
  return ViewGraph({{2, 1},
                    {1, 5},
                    {5, 2},
                    {5, 6},
                    {6, 7},
                    {9, 6},
                    {7, 9},
                    {2, 5},
                    {20, 21}},
                   {30, 1});
}

TEST(ViewGraph, OrdersItsPairsAndDropsRepetitions) {
  const ViewGraph graph = Example();
  EXPECT_THAT(graph.views(), ElementsAre(1, 2, 5, 6, 7, 9, 20, 21, 30));
  EXPECT_THAT(graph.pairs(),
              ElementsAre(ViewPair{1, 2}, ViewPair{1, 5}, ViewPair{2, 5},
                          ViewPair{5, 6}, ViewPair{6, 7}, ViewPair{6, 9},
                          ViewPair{7, 9}, ViewPair{20, 21}));
  EXPECT_EQ(graph.FindPair(9, 6), 5u);
  EXPECT_FALSE(graph.FindPair(1, 6));
  EXPECT_FALSE(graph.FindPair(77, 78));
  EXPECT_THAT(graph.NeighborsOf(6), ElementsAre(5, 7, 9));
  EXPECT_THAT(graph.NeighborsOf(30), IsEmpty());
  EXPECT_THAT(graph.NeighborsOf(77), IsEmpty());
}

TEST(ViewGraph, OfASceneHasAllItsViews) {
  Scene scene;
  for (const ViewId view : {3u, 4u, 8u}) scene.views[view] = View();
  scene.relative_poses[{3, 8}].views = {3, 8};
  const ViewGraph graph(scene);
  EXPECT_THAT(graph.views(), ElementsAre(3, 4, 8));
  EXPECT_THAT(graph.pairs(), ElementsAre(ViewPair{3, 8}));
}

TEST(ViewGraph, WithoutViewsLosesTheirPairs) {
  const ViewGraph graph = Example().WithoutViews({5, 20, 77, 5});
  EXPECT_THAT(graph.views(), ElementsAre(1, 2, 6, 7, 9, 21, 30));
  EXPECT_THAT(graph.pairs(), ElementsAre(ViewPair{1, 2}, ViewPair{6, 7},
                                         ViewPair{6, 9}, ViewPair{7, 9}));
}

TEST(ViewGraph, WithoutPairsKeepsTheirViews) {
  const ViewGraph graph = Example().WithoutPairs({{21, 20}, {1, 77}, {5, 6}});
  EXPECT_EQ(graph.views(), Example().views());
  EXPECT_EQ(graph.pairs().size(), Example().pairs().size() - 2);
  EXPECT_FALSE(graph.FindPair(20, 21));
  EXPECT_FALSE(graph.FindPair(5, 6));
}

TEST(FindTriplets, AreAllPathsOfTwoPairs) {
  const ViewGraph graph = Graph({{1, 2}, {2, 5}, {1, 5}, {5, 9}});
  EXPECT_THAT(FindTriplets(graph),
              ElementsAre(ViewTriplet{1, 2, 5}, ViewTriplet{1, 5, 2},
                          ViewTriplet{1, 5, 9}, ViewTriplet{2, 1, 5},
                          ViewTriplet{2, 5, 9}));
  EXPECT_THAT(FindTriplets(ViewGraph()), IsEmpty());
}

TEST(FindTriangles, AreTheCyclesOfThree) {
  EXPECT_THAT(FindTriangles(Example()),
              ElementsAre(ElementsAre(1, 2, 5), ElementsAre(6, 7, 9)));
  EXPECT_THAT(FindTriangles(Graph({{0, 1}, {1, 2}, {2, 3}, {0, 3}})),
              IsEmpty());
  EXPECT_EQ(
      FindTriangles(Graph({{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}))
          .size(),
      4u);
}

TEST(ConnectedComponents, MostViewsFirst) {
  EXPECT_THAT(ConnectedComponents(Example()),
              ElementsAre(ElementsAre(1, 2, 5, 6, 7, 9), ElementsAre(20, 21),
                          ElementsAre(30)));
  EXPECT_THAT(ConnectedComponents(Example().WithoutPairs({{5, 6}})),
              ElementsAre(ElementsAre(1, 2, 5), ElementsAre(6, 7, 9),
                          ElementsAre(20, 21), ElementsAre(30)));
}

TEST(ArticulationViews, AreThoseThatJoin) {
  EXPECT_THAT(ArticulationViews(Example()), ElementsAre(5, 6));
  EXPECT_THAT(ArticulationViews(Graph({{0, 1}, {1, 2}, {0, 2}})), IsEmpty());
}

TEST(FindBridges, AreThePairsOnNoCycle) {
  EXPECT_THAT(FindBridges(Example()),
              ElementsAre(ViewPair{5, 6}, ViewPair{20, 21}));
}

}  // namespace
}  // namespace lowlap
