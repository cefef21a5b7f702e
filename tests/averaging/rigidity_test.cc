#include "lowlap/averaging/rigidity.h"

#include <gtest/gtest.h>

namespace lowlap {
namespace {

Scene SceneWithEdges(ViewId num_views, const std::vector<ViewPair>& edges) {
  Scene scene;
  for (ViewId view = 0; view < num_views; ++view) scene.views[view] = View();
  for (const ViewPair& edge : edges) {
    scene.relative_poses[edge].views = edge;
  }
  return scene;
}

TEST(AnalyzeRigidity, TwoTrianglesThatShareOneView) {
  const RigidityReport report = AnalyzeRigidity(
      SceneWithEdges(5, {{0, 1}, {0, 2}, {1, 2}, {2, 3}, {2, 4}, {3, 4}}));
  ASSERT_EQ(report.groups.size(), 2u);
  EXPECT_EQ(report.groups[0].views, (std::vector<ViewId>{0, 1, 2}));
  EXPECT_EQ(report.groups[1].views, (std::vector<ViewId>{2, 3, 4}));
  ASSERT_EQ(report.hinges.size(), 1u);
  EXPECT_EQ(report.hinges[0].view, 2u);
}

TEST(AnalyzeRigidity, TwoTrianglesThatShareAnEdgeAreOne) {
  const RigidityReport report = AnalyzeRigidity(
      SceneWithEdges(4, {{0, 1}, {0, 2}, {1, 2}, {1, 3}, {2, 3}}));
  EXPECT_EQ(report.groups.size(), 1u);
  EXPECT_TRUE(report.hinges.empty());
}

TEST(AnalyzeRigidity, EveryEdgeOfAChainFloats) {
  const RigidityReport report =
      AnalyzeRigidity(SceneWithEdges(4, {{0, 1}, {1, 2}, {2, 3}}));
  EXPECT_EQ(report.groups.size(), 3u);
  EXPECT_EQ(report.hinges.size(), 2u);
}

TEST(AnalyzeRigidity, ARectangleInAPlaneIsNotRigid) {
  const RigidityReport report =
      AnalyzeRigidity(SceneWithEdges(4, {{0, 1}, {1, 2}, {2, 3}, {0, 3}}));
  EXPECT_EQ(report.groups.size(), 4u);
}

TEST(AnalyzeRigidity, AGraphWithoutTrianglesMayBeRigid) {
  // K(3,3): 9 edges on 6 views, 2 n - 3, and no triangle.
  const RigidityReport report = AnalyzeRigidity(SceneWithEdges(6, {{0, 3},
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
  const RigidityReport report = AnalyzeRigidity(SceneWithEdges(6, {{0, 1},
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
      AnalyzeRigidity(SceneWithEdges(6, {{0, 1}, {2, 3}, {3, 4}}));
  ASSERT_EQ(report.connected_components.size(), 2u);
  EXPECT_EQ(report.connected_components[0], (std::vector<ViewId>{2, 3, 4}));
  EXPECT_EQ(report.isolated_views, (std::vector<ViewId>{5}));
}

TEST(AnalyzeRigidity, AnEmptySceneHasNothing) {
  const RigidityReport report = AnalyzeRigidity(Scene());
  EXPECT_TRUE(report.groups.empty());
  EXPECT_TRUE(report.hinges.empty());
}

}  // namespace
}  // namespace lowlap
