#include "lowlap/pipeline/internal/believed_evidence.h"

#include <gtest/gtest.h>

namespace lowlap {
namespace {

Track TrackOf(const std::vector<ViewId>& views) {
  Track track;
  for (const ViewId view : views) {
    track.push_back({view, 7});
  }
  return track;
}

Scene SceneOf(const std::vector<Track>& tracks) {
  Scene scene;
  for (std::size_t n = 0; n < tracks.size(); ++n) {
    scene.point_tracks[static_cast<PointTrackId>(n)] = tracks[n];
    scene.line_tracks[static_cast<LineTrackId>(n)] = tracks[n];
  }
  return scene;
}

TEST(BelievedEvidence, WhatOnlyAWrongPairJoinsIsLeftOut) {
  Scene scene = SceneOf({TrackOf({0, 2}), TrackOf({0, 1})});
  const BelievedEvidence believed({{0, 2}}, &scene);
  ASSERT_EQ(scene.point_tracks.size(), 1u);
  EXPECT_EQ(scene.point_tracks.at(1), TrackOf({0, 1}));
  EXPECT_EQ(scene.line_tracks.size(), 1u);
}

TEST(BelievedEvidence, AThirdViewMayJoinTwo) {
  Scene scene = SceneOf({TrackOf({0, 1, 2})});
  const BelievedEvidence believed({{0, 2}}, &scene);
  EXPECT_EQ(scene.point_tracks.at(0), TrackOf({0, 1, 2}));
}

// A scene whose pairs state their matches, all of feature 7 with feature 7.
void Match(const std::vector<ViewPair>& pairs, Scene* scene) {
  for (const ViewPair& views : pairs) {
    RelativePose& pose = scene->relative_poses[views];
    pose.views = views;
    pose.point_inliers = pose.line_inliers = {{7, 7}};
  }
}

TEST(BelievedEvidence, AThirdViewThatMatchesOneOfThemJoinsNothing) {
  Scene scene = SceneOf({TrackOf({0, 1, 2})});
  Match({{0, 1}, {0, 2}, {1, 2}}, &scene);
  // Other points of the views 0 and 1 match, these do not.
  scene.relative_poses.at({0, 1}).point_inliers = {{3, 4}};
  const BelievedEvidence believed({{0, 2}}, &scene);
  EXPECT_EQ(scene.point_tracks.at(0), TrackOf({1, 2}));
  EXPECT_EQ(scene.line_tracks.at(0), TrackOf({0, 1, 2}));
}

TEST(BelievedEvidence, ViewsWithoutRelativePoseAreJoinedOverOthers) {
  Scene scene = SceneOf({TrackOf({0, 1, 2, 3}), TrackOf({0, 2, 3})});
  Match({{0, 1}, {0, 2}, {1, 3}, {2, 3}}, &scene);
  const BelievedEvidence believed({{0, 2}}, &scene);
  EXPECT_EQ(scene.point_tracks.at(0), TrackOf({0, 1, 2, 3}));
  EXPECT_EQ(scene.point_tracks.at(1), TrackOf({2, 3}));
}

TEST(BelievedEvidence, RelativePosesThatWereLeftOutHoldNothing) {
  Scene scene = SceneOf({TrackOf({0, 1, 2})});
  Match({{0, 1}, {0, 2}, {1, 2}}, &scene);
  scene.scale_ratios.resize(2);
  scene.scale_ratios[0].views = {0, 1, 2};
  scene.scale_ratios[1].views = {2, 0, 1};
  {
    const BelievedEvidence believed({{0, 2}, {3, 4}}, &scene);
    EXPECT_EQ(scene.scale_ratios.size(), 1u);
    EXPECT_EQ(scene.relative_poses.size(), 2u);
    EXPECT_EQ(scene.relative_poses.count({0, 2}), 0u);
  }
  EXPECT_EQ(scene.scale_ratios.size(), 2u);
  ASSERT_EQ(scene.relative_poses.size(), 3u);
  EXPECT_EQ(scene.relative_poses.at({0, 2}).point_inliers.size(), 1u);
}

TEST(BelievedEvidence, TheLargestPartStays) {
  Scene scene = SceneOf({TrackOf({0, 1, 2, 3, 4})});
  const BelievedEvidence believed(
      {{0, 2}, {0, 3}, {0, 4}, {1, 2}, {1, 3}, {1, 4}}, &scene);
  EXPECT_EQ(scene.point_tracks.at(0), TrackOf({2, 3, 4}));
}

TEST(BelievedEvidence, SegmentsOfOneViewAreNoTwoViews) {
  Scene scene;
  scene.line_tracks[0] = {{0, 1}, {0, 2}, {3, 1}};
  const BelievedEvidence believed({{0, 3}}, &scene);
  EXPECT_TRUE(scene.line_tracks.empty());
}

TEST(BelievedEvidence, AllComeBack) {
  const Scene before = SceneOf(
      {TrackOf({0, 2}), TrackOf({0, 1}), TrackOf({0, 2, 3}), TrackOf({1, 2})});
  Scene scene = before;
  {
    const BelievedEvidence believed({{0, 2}, {0, 3}}, &scene);
    EXPECT_FALSE(scene.point_tracks == before.point_tracks);
  }
  EXPECT_EQ(scene.point_tracks, before.point_tracks);
  EXPECT_EQ(scene.line_tracks, before.line_tracks);
}

}  // namespace
}  // namespace lowlap
