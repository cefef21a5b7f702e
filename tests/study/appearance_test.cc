#include "lowlap/study/internal/trust/appearance.h"

#include <gtest/gtest.h>

#include <map>

#include "lowlap/matching/internal/matching.h"

namespace lowlap {
namespace {

SyntheticScene House(double alike_share) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kHouse;
  options.num_views = 12;
  options.pairs = "all";
  options.points_per_wall = 120;
  options.lines_per_wall = 40;
  options.box_offset_m = 0.3;
  options.alike_share = alike_share;
  return *Simulate(options);
}

// Of the matches of two views, by whether one track has both features.
struct Matches {
  int num_right = 0, num_false = 0;
};

Matches MatchesOf(const SyntheticScene& synthetic, ViewId first, ViewId second,
                  const LikenessOptions& likeness = {}) {
  const auto detected = DescribeFeatures(synthetic, likeness, 0);
  const PairMatches matches =
      MatchPair(detected.at(first), detected.at(second), MatchOptions());
  std::map<FeatureRef, PointTrackId> track_of;
  for (const auto& [id, track] : synthetic.scene.point_tracks) {
    for (const FeatureRef& ref : track) track_of[ref] = id;
  }
  Matches count;
  for (const FeatureMatch& match : matches.points) {
    (track_of.at({first, match.first}) == track_of.at({second, match.second})
         ? count.num_right
         : count.num_false)++;
  }
  return count;
}

TEST(DescribeFeatures, NeighborsMatchWhatBothSee) {
  const Matches matches = MatchesOf(House(0), 0, 1);
  EXPECT_GT(matches.num_right, 60);
  EXPECT_LT(matches.num_false, matches.num_right / 10);
}

TEST(DescribeFeatures, OppositeViewsMatchWhatLooksTheSame) {
  EXPECT_LT(MatchesOf(House(0), 0, 6).num_false, 10);
  const Matches alike = MatchesOf(House(0.5), 0, 6);
  EXPECT_EQ(alike.num_right, 0);
  EXPECT_GT(alike.num_false, 40);
}

TEST(DescribeFeatures, WhatIsNotFoundLooksLikeNothingElse) {
  const SyntheticScene synthetic = House(0);
  LikenessOptions likeness;
  likeness.found_share = 0;
  const auto found = DescribeFeatures(synthetic, likeness, 0);
  EXPECT_LT(MatchPair(found.at(0), found.at(1), MatchOptions()).points.size(),
            10u);
  const auto again = DescribeFeatures(synthetic, likeness, 0);
  EXPECT_EQ(found.at(0).point_descriptors, again.at(0).point_descriptors);
  EXPECT_EQ(found.at(0).line_descriptors, again.at(0).line_descriptors);
}

TEST(DescribeFeatures, TwoSessionsFindWhatHasNotChanged) {
  const SyntheticScene synthetic = House(0);
  LikenessOptions likeness;
  likeness.changed_share = 0.5;
  likeness.second_session = {1, 2};
  const int num_of_all = MatchesOf(synthetic, 0, 1).num_right;
  const int num_of_both = MatchesOf(synthetic, 0, 1, likeness).num_right;
  EXPECT_GT(num_of_both, 0.35 * num_of_all);
  EXPECT_LT(num_of_both, 0.65 * num_of_all);
  EXPECT_GT(MatchesOf(synthetic, 1, 2, likeness).num_right, 0.8 * num_of_all);
  likeness.changed_share = 0;
  EXPECT_EQ(MatchesOf(synthetic, 0, 1, likeness).num_right, num_of_all);
}

}  // namespace
}  // namespace lowlap
