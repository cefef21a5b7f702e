#include "lowlap/scale/internal/unrepeated_scene.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lowlap/scale/triplet_view.h"
#include "scale/row_of_views.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using testing::RowOfViews;

TEST(WithoutRepeatedMatches, LeavesOutWhatRepeatsInAnyView) {
  Scene scene = RowOfViews().scene;
  scene.features.at(0).repeated_points = {3, 5};
  scene.features.at(1).repeated_points = {5, 8};
  scene.features.at(2).repeated_points = {59};
  scene.features.at(0).repeated_segments = {1};
  scene.features.at(1).repeated_segments = {20, 21};
  scene.features.at(2).repeated_segments = {2};
  const Scene without = WithoutRepeatedMatches(scene).scene;
  const SceneFeatures features(scene), features_without(without);
  const auto all = MakeTripletView(features, {0, 1, 2});
  const auto unrepeated = MakeTripletView(features_without, {0, 1, 2});
  ASSERT_TRUE(all.has_value() && unrepeated.has_value());
  EXPECT_EQ(all->points.size(), 60u);
  EXPECT_EQ(unrepeated->points.size(), 56u);
  EXPECT_EQ(all->lines.size(), 40u);
  EXPECT_EQ(unrepeated->lines.size(), 36u);
  EXPECT_EQ(unrepeated->lines_ij.size(), 37u);
  EXPECT_EQ(unrepeated->lines_jk.size(), 37u);
}

TEST(WithoutRepeatedMatches, NamesThePosesThatLostSome) {
  Scene scene = RowOfViews().scene;
  EXPECT_TRUE(WithoutRepeatedMatches(scene).changed.empty());
  EXPECT_TRUE(WithoutRepeatedMatches(scene).scene == scene);
  // What repeats without a match changes nothing.
  scene.features.at(0).repeated_points = {4};
  RelativePose& pose = scene.relative_poses.at({0, 1});
  ASSERT_EQ(pose.point_inliers[4].first, 4u);
  scene.relative_poses = {{{0, 1}, pose},
                          {{1, 2}, scene.relative_poses.at({1, 2})}};
  const UnrepeatedScene with_match = WithoutRepeatedMatches(scene);
  EXPECT_THAT(with_match.changed, ElementsAre(ViewPair{0, 1}));
  EXPECT_EQ(with_match.scene.relative_poses.at({0, 1}).point_inliers.size(),
            scene.relative_poses.at({0, 1}).point_inliers.size() - 1);
  auto& inliers = scene.relative_poses.at({0, 1}).point_inliers;
  inliers.erase(inliers.begin() + 4);
  EXPECT_TRUE(WithoutRepeatedMatches(scene).changed.empty());
}

}  // namespace
}  // namespace lowlap
