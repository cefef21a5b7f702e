#include "lowlap/averaging/strategies/internal/track_groups.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "averaging/strategies/ray_problem.h"

namespace lowlap {
namespace {

using Groups = std::vector<std::vector<std::size_t>>;

// `count` points that these views see.
void AddTracks(int count, const std::vector<std::size_t>& views,
               std::vector<TrackRays>* tracks) {
  for (int k = 0; k < count; ++k) {
    TrackRays track;
    for (const std::size_t view : views) {
      track.observations.push_back({view, Vec3::UnitZ()});
    }
    tracks->push_back(track);
  }
}

TEST(GroupViewsByTracks, AViewJoinsByPointsThatTwoViewsSee) {
  const RandomProblem made = MakeRayRing(9, 63, 3, false, 14);  // 9 per start
  const auto& tracks = made.problem.tracks;
  EXPECT_EQ(GroupViewsByTracks(9, tracks, 3, 5),
            (Groups{{0, 1, 2, 3, 4, 5, 6, 7, 8}}));
  // Neighbours share 18 points (nine at the ends), of which a third view sees
  // nine.
  EXPECT_EQ(GroupViewsByTracks(9, tracks, 3, 10),
            (Groups{{1, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {6, 7}}));
  EXPECT_TRUE(GroupViewsByTracks(9, tracks, 4, 5).empty());
}

TEST(GroupViewsByTracks, PairsThatSharePointsWithNoThirdViewAreGroups) {
  std::vector<TrackRays> tracks;
  AddTracks(5, {0, 1}, &tracks);
  AddTracks(7, {1, 2}, &tracks);
  AddTracks(4, {2, 3}, &tracks);
  // The pair with more points comes first.
  EXPECT_EQ(GroupViewsByTracks(4, tracks, 2, 5), (Groups{{1, 2}, {0, 1}}));
  EXPECT_TRUE(GroupViewsByTracks(4, tracks, 2, 8).empty());
}

TEST(GroupViewsByTracks, APointIsKnownOnceTwoViewsOfTheGroupSeeIt) {
  std::vector<TrackRays> tracks;
  AddTracks(9, {0, 1}, &tracks);
  AddTracks(3, {0, 2, 3}, &tracks);
  AddTracks(3, {1, 2, 3}, &tracks);
  // View 2 sees six points of one view each, none of two.
  EXPECT_EQ(GroupViewsByTracks(4, tracks, 2, 5), (Groups{{0, 1}, {2, 3}}));
  // With two in the group it sees enough, and then view 3 does.
  AddTracks(5, {0, 1, 2}, &tracks);
  EXPECT_EQ(GroupViewsByTracks(4, tracks, 2, 5), (Groups{{0, 1, 2, 3}}));
}

TEST(GroupViewsByTracks, ShortTracksAreNotSeen) {
  std::vector<TrackRays> tracks;
  AddTracks(20, {0, 1}, &tracks);
  AddTracks(5, {1, 2, 3}, &tracks);
  EXPECT_EQ(GroupViewsByTracks(4, tracks, 3, 5), (Groups{{1, 2, 3}}));
}

TEST(GroupViewsByTracks, DoesNotDependOnTheOrderOfTheTracks) {
  std::vector<TrackRays> tracks =
      MakeRayRing(12, 300, 4, false, 3).problem.tracks;
  // Two groups that share a view, and a longer one.
  tracks.erase(std::remove_if(tracks.begin(), tracks.end(),
                              [](const TrackRays& track) {
                                return track.observations.front().view < 4 &&
                                       track.observations.back().view > 4;
                              }),
               tracks.end());
  const Groups expected = {{4, 5, 6, 7, 8, 9, 10, 11}, {0, 1, 2, 3, 4}};
  EXPECT_EQ(GroupViewsByTracks(12, tracks, 3, 5), expected);
  std::reverse(tracks.begin(), tracks.end());
  for (TrackRays& track : tracks) {
    std::reverse(track.observations.begin(), track.observations.end());
  }
  EXPECT_EQ(GroupViewsByTracks(12, tracks, 3, 5), expected);
}

TEST(GroupViewsByTracks, OfNothingAreNone) {
  EXPECT_TRUE(GroupViewsByTracks(3, {}, 2, 2).empty());
  EXPECT_TRUE(GroupViewsByTracks(0, {}, 2, 2).empty());
}

}  // namespace
}  // namespace lowlap
