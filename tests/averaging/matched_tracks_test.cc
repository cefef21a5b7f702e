#include "lowlap/averaging/internal/matched_tracks.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>

namespace lowlap {
namespace {

using ::testing::IsEmpty;

// Four views with five features each, 100 px apart, and no matches yet.
Scene FourViews() {
  Scene scene;
  for (std::uint32_t view = 0; view < 4; ++view) {
    for (int n = 0; n < 5; ++n) {
      scene.features[view].points_px.push_back(Vec2(100.0 * n, 50));
    }
  }
  return scene;
}

const std::vector<ViewId> kAll = {0, 1, 2, 3};

void Match(ViewId a, FeatureIndex in_a, ViewId b, FeatureIndex in_b,
           Scene* scene) {
  scene->relative_poses[{a, b}].point_inliers.push_back({in_a, in_b});
}

std::vector<Track> TracksOf(const Scene& scene,
                            const std::vector<ViewId>& views = kAll,
                            const std::set<ViewPair>& excluded = {}) {
  std::vector<Track> tracks;
  for (const auto& [id, track] : MatchedTracks(scene, views, excluded)) {
    EXPECT_EQ(id, PointTrackId(static_cast<std::uint32_t>(tracks.size())));
    tracks.push_back(track);
  }
  return tracks;
}

TEST(MatchedTracks, AreTheSetsThatMatchesJoin) {
  Scene scene = FourViews();
  Match(0, 1, 1, 2, &scene);
  Match(1, 2, 3, 0, &scene);
  Match(0, 0, 2, 4, &scene);
  Match(2, 4, 3, 3, &scene);
  const std::vector<Track> expected = {{{0, 0}, {2, 4}, {3, 3}},
                                       {{0, 1}, {1, 2}, {3, 0}}};
  EXPECT_EQ(TracksOf(scene), expected);
}

TEST(MatchedTracks, DoNotDependOnTheOrderOfTheMatches) {
  Scene scene = FourViews();
  for (FeatureIndex n = 0; n < 5; ++n) {
    Match(0, n, 1, (n + 1) % 5, &scene);
    Match(1, n, 2, (n + 2) % 5, &scene);
    if (n != 2) Match(2, n, 3, n, &scene);
  }
  const std::vector<Track> before = TracksOf(scene);
  EXPECT_EQ(before.size(), 5u);
  for (auto& entry : scene.relative_poses) {
    std::reverse(entry.second.point_inliers.begin(),
                 entry.second.point_inliers.end());
  }
  EXPECT_EQ(TracksOf(scene), before);
}

TEST(MatchedTracks, HoldNoMatchOfOtherViewsNorOfExcludedPairs) {
  Scene scene = FourViews();
  Match(0, 1, 1, 1, &scene);
  Match(1, 1, 2, 1, &scene);
  Match(2, 1, 3, 1, &scene);
  EXPECT_EQ(TracksOf(scene, {0, 1, 3}), (std::vector<Track>{{{0, 1}, {1, 1}}}));
  EXPECT_EQ(TracksOf(scene, kAll, {{1, 2}}),
            (std::vector<Track>{{{0, 1}, {1, 1}}, {{2, 1}, {3, 1}}}));
}

TEST(MatchedTracks, IgnoreMatchesOfFeaturesThatDoNotExist) {
  Scene scene = FourViews();
  Match(0, 0, 1, 5, &scene);
  Match(0, 1, 1, 1, &scene);
  Match(0, 2, 7, 0, &scene);
  EXPECT_EQ(TracksOf(scene, {0, 1, 7}), (std::vector<Track>{{{0, 1}, {1, 1}}}));
}

// The set of features 0 and 1 of view 0, `apart_px` from each other.
std::vector<Track> TracksOfTwins(double apart_px) {
  Scene scene = FourViews();
  auto& points_px = scene.features[0].points_px;
  points_px[1] = points_px[0] + Vec2(0, apart_px);
  Match(0, 0, 1, 0, &scene);
  Match(0, 1, 2, 0, &scene);
  Match(1, 0, 2, 0, &scene);
  return TracksOf(scene);
}

TEST(MatchedTracks, ClosePointsOfOneViewAreOneAndDistantOnesContradict) {
  EXPECT_EQ(TracksOfTwins(10), (std::vector<Track>{{{0, 0}, {1, 0}, {2, 0}}}));
  EXPECT_THAT(TracksOfTwins(10.001), IsEmpty());
}

TEST(MatchedTracks, AnyTwoPointsOfAViewMustBeClose) {
  Scene scene = FourViews();
  auto& points_px = scene.features[0].points_px;
  // The first is close to both others, which are 16 px apart.
  points_px[1] = points_px[0] + Vec2(8, 0);
  points_px[2] = points_px[0] - Vec2(8, 0);
  for (FeatureIndex n = 0; n < 3; ++n) Match(0, n, 1, 0, &scene);
  EXPECT_THAT(TracksOf(scene), IsEmpty());
}

TEST(MatchedTracks, AreThoseOfTheSceneOnlyWithoutAnyMatch) {
  Scene scene = FourViews();
  scene.relative_poses[{0, 1}];
  scene.point_tracks[7] = {{0, 3}, {1, 3}};
  EXPECT_EQ(MatchedTracks(scene, kAll, {}), scene.point_tracks);
  Match(0, 1, 1, 1, &scene);
  EXPECT_THAT(TracksOf(scene, kAll, {{0, 1}}), IsEmpty());
}

}  // namespace
}  // namespace lowlap
