#include "lowlap/averaging/rigidity/internal/rigidity.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "averaging/rigidity/scene_with_edges.h"

namespace lowlap {
namespace {

ViewGraph Graph(std::uint32_t num_views, const std::vector<ViewPair>& edges) {
  return ViewGraph(SceneWithEdges(num_views, edges));
}

TEST(AnalyzeRigidity, TwoTrianglesThatShareOneView) {
  const RigidityReport report = AnalyzeRigidity(
      Graph(5, {{0, 1}, {0, 2}, {1, 2}, {2, 3}, {2, 4}, {3, 4}}));
  ASSERT_EQ(report.groups.size(), 2u);
  EXPECT_EQ(report.groups[0].views, (std::vector<ViewId>{0, 1, 2}));
  EXPECT_EQ(report.groups[1].views, (std::vector<ViewId>{2, 3, 4}));
  ASSERT_EQ(report.articulation_views.size(), 1u);
  EXPECT_EQ(report.articulation_views[0].view, 2u);
}

TEST(AnalyzeRigidity, TwoTrianglesThatShareAnEdgeAreOne) {
  const RigidityReport report =
      AnalyzeRigidity(Graph(4, {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}}));
  EXPECT_EQ(report.groups.size(), 1u);
  EXPECT_TRUE(report.articulation_views.empty());
}

TEST(AnalyzeRigidity, EveryEdgeOfAChainFloats) {
  const RigidityReport report =
      AnalyzeRigidity(Graph(4, {{0, 1}, {1, 2}, {2, 3}}));
  EXPECT_EQ(report.groups.size(), 3u);
  EXPECT_EQ(report.articulation_views.size(), 2u);
}

TEST(AnalyzeRigidity, ARectangleInAPlaneIsNotRigid) {
  const RigidityReport report =
      AnalyzeRigidity(Graph(4, {{0, 1}, {1, 2}, {2, 3}, {0, 3}}));
  EXPECT_EQ(report.groups.size(), 4u);
}

TEST(AnalyzeRigidity, AGraphWithoutTrianglesMayBeRigid) {
  // K(3,3): 9 edges on 6 views, 2 n - 3, and no triangle.
  const RigidityReport report = AnalyzeRigidity(Graph(6, {{0, 3},
                                                          {0, 4},
                                                          {0, 5},
                                                          {1, 3},
                                                          {1, 4},
                                                          {1, 5},
                                                          {2, 3},
                                                          {2, 4},
                                                          {2, 5}}));
  EXPECT_EQ(report.groups.size(), 1u);
}

TEST(AnalyzeRigidity, ThreeGroupsInARingOfHingesAreOne) {
  // Triangles 0-1-2, 2-3-4, 4-5-0 meet in 2, 4, 0: a triangle of groups.
  const RigidityReport report = AnalyzeRigidity(Graph(6, {{0, 1},
                                                          {0, 2},
                                                          {1, 2},
                                                          {2, 3},
                                                          {2, 4},
                                                          {3, 4},
                                                          {4, 5},
                                                          {0, 4},
                                                          {0, 5}}));
  EXPECT_EQ(report.groups.size(), 1u);
}

TEST(AnalyzeRigidity, PartsAndIsolatedViewsAreNamed) {
  const RigidityReport report =
      AnalyzeRigidity(Graph(6, {{0, 1}, {2, 3}, {3, 4}}));
  ASSERT_EQ(report.connected_components.size(), 2u);
  EXPECT_EQ(report.connected_components[0], (std::vector<ViewId>{2, 3, 4}));
  EXPECT_EQ(report.isolated_views, (std::vector<ViewId>{5}));
}

TEST(AnalyzeTripletRigidity, TripletsNeedSharedTracks) {
  // Directions make one rigid group of two triangles that share an edge; the
  // second triangle shares too few tracks to count as a triplet.
  Scene scene = SceneWithEdges(4, {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}});
  for (std::uint32_t id = 0; id < 40; ++id) {
    scene.point_tracks[id] = {{0, id}, {1, id}, {2, id}};
    if (id < 29) scene.point_tracks[id].push_back({3, id});
  }
  RigidityReport report = AnalyzeTripletRigidity(scene);
  ASSERT_EQ(report.groups.size(), 1u);
  EXPECT_EQ(report.groups[0].views, (std::vector<ViewId>{0, 1, 2}));
  EXPECT_EQ(report.isolated_views, (std::vector<ViewId>{3}));
  report = AnalyzeTripletRigidity(scene, 29);
  ASSERT_EQ(report.groups.size(), 1u);
  EXPECT_EQ(report.groups[0].views.size(), 4u);
}

TEST(AnalyzeTripletRigidity, TripletsThatShareOneViewKeepTheirOwnScale) {
  // A ring of three triplets is rigid by directions, not by triplets.
  Scene scene = SceneWithEdges(
      6,
      {{0, 1}, {0, 2}, {1, 2}, {2, 3}, {2, 4}, {3, 4}, {4, 5}, {0, 4}, {0, 5}});
  for (std::uint32_t id = 0; id < 90; ++id) {
    const std::uint32_t a = id % 3 * 2, b = a + 1, c = (a + 2) % 6;
    Track track = {{a, id}, {b, id}, {c, id}};
    std::sort(track.begin(), track.end());
    scene.point_tracks[id] = track;
  }
  const RigidityReport report = AnalyzeTripletRigidity(scene);
  EXPECT_EQ(report.groups.size(), 3u);
  EXPECT_EQ(report.articulation_views.size(), 3u);
}

// A step for every three views of each track would take an hour.
TEST(AnalyzeTripletRigidity, TracksMayRunThroughAllViews) {
  constexpr std::uint32_t kNumViews = 2000;
  std::vector<ViewPair> edges;
  for (std::uint32_t n = 0; n + 1 < kNumViews; ++n) {
    edges.push_back({n, n + 1});
    if (n + 2 < kNumViews) edges.push_back({n, n + 2});
  }
  Scene scene = SceneWithEdges(kNumViews, edges);
  for (std::uint32_t id = 0; id < 30; ++id) {
    for (std::uint32_t view = 0; view < kNumViews; ++view) {
      if (id == 0 && view == 1000) continue;
      scene.point_tracks[id].push_back({view, id});
    }
  }
  EXPECT_EQ(AnalyzeTripletRigidity(scene, 29).groups.size(), 1u);
  // Without the three triangles at view 1000, one view joins nothing.
  const RigidityReport report = AnalyzeTripletRigidity(scene, 30);
  ASSERT_EQ(report.groups.size(), 2u);
  EXPECT_EQ(report.groups[0].views.size(), 1000u);
  EXPECT_EQ(report.groups[1].views.size(), 999u);
  EXPECT_EQ(report.isolated_views, std::vector<ViewId>{1000});
}

TEST(AnalyzeRigidity, AnEmptyGraphHasNothing) {
  const RigidityReport report = AnalyzeRigidity(ViewGraph());
  EXPECT_TRUE(report.groups.empty());
  EXPECT_TRUE(report.articulation_views.empty());
}

// Three views on a line, and a fourth beside it.
TEST(Rigidity, LengthsOnALineAddUp) {
  const ViewGraph graph({{0, 1}, {0, 2}, {1, 2}, {0, 3}, {2, 3}});
  const std::vector<ViewTriplet> flat = {{0, 1, 2}};
  EXPECT_EQ(AnalyzeRigidity(graph).groups.size(), 1u);
  const RigidityReport open = AnalyzeRigidity(graph, {}, flat);
  ASSERT_EQ(open.groups.size(), 1u);
  const ViewGraph line({{0, 1}, {0, 2}, {1, 2}});
  EXPECT_EQ(AnalyzeRigidity(line, {}, flat).groups.size(), 3u);
  for (const ViewTriplet& ratio :
       {ViewTriplet{0, 1, 2}, ViewTriplet{1, 0, 2}, ViewTriplet{0, 2, 1}}) {
    EXPECT_EQ(AnalyzeRigidity(line, {ratio}, flat).groups.size(), 1u);
  }
}

std::set<std::vector<ViewPair>> EdgesOfGroups(const RigidityReport& report) {
  std::set<std::vector<ViewPair>> edges;
  for (const RigidGroup& group : report.groups) edges.insert(group.edges);
  return edges;
}

// Views 1 and 2 stand side by side, and see 0 and 3 far away: their distance
// compares nothing with anything.
TEST(Rigidity, ViewsSideBySideCarryNoScale) {
  const ViewGraph graph({{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}});
  const std::vector<ViewTriplet> narrow = {{1, 0, 2}, {1, 3, 2}};
  EXPECT_EQ(AnalyzeRigidity(graph).groups.size(), 1u);
  using Groups = std::set<std::vector<ViewPair>>;
  EXPECT_EQ(EdgesOfGroups(AnalyzeRigidity(graph, {}, {}, narrow)),
            (Groups{{{0, 1}, {0, 2}}, {{1, 3}, {2, 3}}, {{1, 2}}}));
  // A ratio does.
  EXPECT_EQ(EdgesOfGroups(AnalyzeRigidity(graph, {{0, 1, 3}}, {}, narrow)),
            (Groups{{{0, 1}, {0, 2}, {1, 3}, {2, 3}}, {{1, 2}}}));
  EXPECT_EQ(
      AnalyzeRigidity(graph, {{0, 1, 2}, {2, 1, 3}}, {}, narrow).groups.size(),
      1u);
}

// On a line with the far view, directions do not say that they are near.
TEST(Rigidity, OfLongLengthsOnALineTheDifferenceIsNotKnown) {
  const ViewGraph line({{0, 1}, {0, 2}, {1, 2}});
  const std::vector<ViewTriplet> flat = {{0, 1, 2}}, narrow = {{1, 0, 2}};
  EXPECT_EQ(AnalyzeRigidity(line, {}, flat, narrow).groups.size(), 3u);
  using Groups = std::set<std::vector<ViewPair>>;
  EXPECT_EQ(EdgesOfGroups(AnalyzeRigidity(line, {{1, 0, 2}}, flat, narrow)),
            (Groups{{{0, 1}, {0, 2}}, {{1, 2}}}));
  EXPECT_EQ(AnalyzeRigidity(line, {{0, 1, 2}}, flat, narrow).groups.size(), 1u);
}

// The near views are one place whether or not a relative pose joins them.
TEST(Rigidity, ViewsAtOnePlaceShareOneView) {
  const ViewGraph graph({{0, 1}, {0, 2}, {1, 3}, {2, 3}});
  const std::vector<ViewTriplet> ratios = {{1, 0, 2}, {1, 3, 2}};
  EXPECT_EQ(AnalyzeRigidity(graph, ratios).groups.size(), 1u);
  EXPECT_EQ(AnalyzeRigidity(graph, ratios, {}, ratios).groups.size(), 2u);
}

// ... but a wide triangle beside them does.
TEST(Rigidity, AShortEdgeIsHeldByATriangleOfItsSize) {
  const ViewGraph graph(
      {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}, {1, 4}, {2, 4}});
  EXPECT_EQ(
      AnalyzeRigidity(graph, {}, {}, {{1, 0, 2}, {1, 3, 2}}).groups.size(), 1u);
}

}  // namespace
}  // namespace lowlap
