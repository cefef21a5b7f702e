#include "lowlap/averaging/centers/internal/contests.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

// Two triangles, 0-1-2 and 3-4-5, and what joins them.
EvidenceOfPairs TwoGroups(const EvidenceOfPairs& links) {
  EvidenceOfPairs pairs = links;
  for (const ViewId first : {0u, 3u}) {
    const ViewId second = first.value() + 1, third = first.value() + 2;
    pairs[{first, second}] = 100;
    pairs[{first, third}] = 100;
    pairs[{second, third}] = 100;
  }
  return pairs;
}

TEST(Contests, LinksWithHardlyMoreEvidenceThanWhatContradictsThem) {
  const auto contests = FindContests(TwoGroups({{{2, 3}, 30}, {{1, 3}, 20}}),
                                     {}, {{{1, 4}, {20}}, {{2, 5}, {15}}});
  ASSERT_EQ(contests.size(), 1u);
  EXPECT_THAT(contests[0].links, ElementsAre(ViewPair{1, 3}, ViewPair{2, 3}));
  EXPECT_THAT(contests[0].contradictions,
              ElementsAre(ViewPair{1, 4}, ViewPair{2, 5}));
  EXPECT_EQ(contests[0].views.size(), 3u);
}

TEST(Contests, NoneWhereTheEvidenceDecides) {
  EXPECT_THAT(FindContests(TwoGroups({{{2, 3}, 30}, {{1, 3}, 20}}), {},
                           {{{1, 4}, {10}}, {{2, 5}, {10}}}),
              IsEmpty());
}

RejectedPose Turned(double evidence, double angle_deg, const Vec3& axis,
                    double stddev_deg = 0.1) {
  return {evidence, RotationFromAngleAxis(RadFromDeg(angle_deg) * axis),
          RadFromDeg(stddev_deg)};
}

TEST(Contests, WhatTurnsTheViewsInDifferentWaysIsNotRightTogether) {
  const EvidenceOfPairs in_use = TwoGroups({{{2, 3}, 30}, {{1, 3}, 20}});
  EXPECT_THAT(FindContests(in_use, {},
                           {{{1, 4}, Turned(20, 90, Vec3::UnitX())},
                            {{2, 5}, Turned(20, 90, Vec3::UnitY())}}),
              IsEmpty());
}

// 0-1-5 and 2-3-4: the first view of one rejected pair and the second of the
// other are of the same group, so that the same turn of it is inverse in one.
TEST(Contests, WhatTurnsTheViewsInOneWayCountsTogether) {
  const EvidenceOfPairs in_use = {{{0, 1}, 100}, {{0, 5}, 100}, {{1, 5}, 100},
                                  {{2, 3}, 100}, {{2, 4}, 100}, {{3, 4}, 100},
                                  {{1, 3}, 30},  {{1, 4}, 20}};
  const RejectedPose leaves = Turned(20, 90, Vec3::UnitX());
  const RejectedPose enters = Turned(15, -93, Vec3::UnitX());
  const RejectedPose elsewhere = Turned(30, 90, Vec3::UnitY());
  const auto contests = FindContests(
      in_use, {}, {{{0, 4}, leaves}, {{0, 2}, elsewhere}, {{3, 5}, enters}});
  ASSERT_EQ(contests.size(), 1u);
  EXPECT_THAT(contests[0].contradictions,
              ElementsAre(ViewPair{0, 4}, ViewPair{3, 5}));
}

TEST(Contests, AVagueTurnAgreesWithWhatItMayBe) {
  const EvidenceOfPairs in_use = TwoGroups({{{2, 3}, 30}, {{1, 3}, 20}});
  const RejectedPose one = Turned(20, 90, Vec3::UnitX());
  EXPECT_EQ(
      FindContests(in_use, {},
                   {{{1, 4}, one}, {{2, 5}, Turned(20, 60, Vec3::UnitX(), 11)}})
          .size(),
      1u);
  EXPECT_THAT(
      FindContests(in_use, {},
                   {{{1, 4}, one}, {{2, 5}, Turned(20, 60, Vec3::UnitX(), 9)}}),
      IsEmpty());
}

TEST(Contests, NoneWithinAGroupThatHolds) {
  EvidenceOfPairs all;
  for (std::uint32_t a = 0; a < 6; ++a) {
    for (std::uint32_t b = a + 1; b < 6; ++b) all[{a, b}] = 100;
  }
  all.erase({0, 1});
  EXPECT_THAT(FindContests(all, {}, {{{0, 1}, {150}}}), IsEmpty());
}

TEST(Contests, NoneBetweenViewsThatNothingJoins) {
  EXPECT_THAT(FindContests(TwoGroups({}), {}, {{{2, 3}, {50}}}), IsEmpty());
}

TEST(Contests, TheSmallerSideIsNamed) {
  EvidenceOfPairs in_use = TwoGroups({{{2, 3}, 30}, {{1, 3}, 30}});
  in_use[{5, 6}] = 20;
  const auto contests = FindContests(in_use, {}, {{{4, 6}, {15}}});
  ASSERT_EQ(contests.size(), 1u);
  EXPECT_THAT(contests[0].views, ElementsAre(6));
}

// 0 - 1 - 2 - 3, and a pose of its ends that contradicts every link.
TEST(Contests, OneCauseIsOneContest) {
  const auto contests =
      FindContests({{{0, 1}, 20}, {{1, 2}, 500}, {{2, 3}, 10}},
                   {{{0, 1, 2}, 8}, {{1, 2, 3}, 9}}, {{{0, 3}, {15}}});
  ASSERT_EQ(contests.size(), 1u);
  EXPECT_THAT(contests[0].contradictions, ElementsAre(ViewPair{0, 3}));
  EXPECT_THAT(contests[0].views, ElementsAre(0, 3));
  EXPECT_THAT(contests[0].links, ElementsAre(ViewPair{0, 1}, ViewPair{2, 3}));
}

// The ways that the first pair fills are open again for the second.
TEST(Contests, EveryRejectedPairIsHeldAgainstTheWholeGraph) {
  const auto contests = FindContests({{{0, 1}, 20}, {{1, 2}, 30}, {{2, 3}, 10}},
                                     {}, {{{0, 2}, {15}}, {{0, 3}, {15}}});
  ASSERT_EQ(contests.size(), 2u);
  EXPECT_THAT(contests[0].contradictions,
              ElementsAre(ViewPair{0, 2}, ViewPair{0, 3}));
  EXPECT_THAT(contests[0].links, ElementsAre(ViewPair{0, 1}));
  EXPECT_THAT(contests[0].views, ElementsAre(0));
  EXPECT_THAT(contests[1].contradictions, ElementsAre(ViewPair{0, 3}));
  EXPECT_THAT(contests[1].links, ElementsAre(ViewPair{2, 3}));
  EXPECT_THAT(contests[1].views, ElementsAre(3));
}

// Two triangles that share view 2.
EvidenceOfPairs TwoTriangles() {
  return {{{0, 1}, 100}, {{0, 2}, 100}, {{1, 2}, 100}, {{2, 3}, 100},
          {{2, 4}, 100}, {{3, 4}, 100}, {{3, 5}, 100}};
}

TEST(ScaleContests, TheBestRatioAcrossAJointAgainstWhatPassesItBy) {
  const std::map<ViewTriplet, double> ratios = {
      {{0, 2, 3}, 9}, {{1, 2, 3}, 6}, {{0, 1, 2}, 500}, {{3, 2, 4}, 500}};
  const auto contests =
      FindContests(TwoTriangles(), ratios, {{{1, 4}, {5}}, {{0, 2}, {50}}});
  ASSERT_EQ(contests.size(), 1u);
  EXPECT_THAT(contests[0].views, ElementsAre(0, 1));
  EXPECT_THAT(contests[0].links, ElementsAre(ViewPair{0, 2}, ViewPair{1, 2}));
  EXPECT_THAT(contests[0].weakest_links, IsEmpty());
  EXPECT_EQ(contests[0].evidence, 9);
  EXPECT_THAT(contests[0].contradictions, ElementsAre(ViewPair{1, 4}));
}

TEST(ScaleContests, NoneWhereTheRatioDecides) {
  EXPECT_THAT(FindContests(TwoTriangles(), {{{0, 2, 3}, 11}},
                           {{{1, 4}, {5}}, {{0, 2}, {50}}}),
              IsEmpty());
}

TEST(ScaleContests, NoneWithoutAJoint) {
  EvidenceOfPairs in_use = TwoTriangles();
  in_use[{1, 4}] = 1;
  EXPECT_THAT(FindContests(in_use, {{{0, 2, 3}, 2}}, {{{0, 4}, {50}}}),
              IsEmpty());
}

TEST(Contests, TellTheLeastEvidenceAndWhatIsAgainstIt) {
  const auto contests = FindContests({{{0, 1}, 30}, {{1, 2}, 20}, {{2, 3}, 25}},
                                     {}, {{{0, 3}, {18}}, {{0, 2}, {7}}});
  ASSERT_EQ(contests.size(), 1u);
  EXPECT_THAT(contests[0].weakest_links, ElementsAre(ViewPair{1, 2}));
  EXPECT_EQ(contests[0].evidence, 20);
  EXPECT_THAT(contests[0].contradictions,
              ElementsAre(ViewPair{0, 2}, ViewPair{0, 3}));
  EXPECT_THAT(contests[0].evidence_against, ElementsAre(7, 18));
}

// Many ways of little evidence lead to the one link of much.
TEST(Contests, ALinkThatManyWaysLeadTo) {
  EvidenceOfPairs in_use;
  for (std::uint32_t a = 0; a < 24; ++a) {
    for (std::uint32_t b = a + 1; b < 24; ++b) {
      if ((a < 12) == (b < 12)) in_use[{a, b}] = 40;
    }
  }
  in_use[{11, 12}] = 400;
  const auto contests = FindContests(in_use, {}, {{{0, 23}, {300}}});
  ASSERT_EQ(contests.size(), 1u);
  EXPECT_THAT(contests[0].links, ElementsAre(ViewPair{11, 12}));
  EXPECT_EQ(contests[0].views.size(), 12u);
}

}  // namespace
}  // namespace lowlap
