#include "lowlap/averaging/rotations/internal/bridges.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;
using ::testing::Pair;

// Two triangles 0-1-2 and 4-5-6, joined by 2-3 and 3-4.
ViewGraph TwoTriangles() {
  return ViewGraph(std::vector<ViewPair>{
      {0, 1}, {1, 2}, {0, 2}, {2, 3}, {3, 4}, {4, 5}, {5, 6}, {4, 6}});
}

TEST(ExamineBridges, AreThePairsOnNoCycle) {
  const BridgeReport report = ExamineBridges(TwoTriangles(), {});
  EXPECT_EQ(report.bridges.size(), 2u);
  for (const ViewPair& bridge : {ViewPair{2, 3}, ViewPair{3, 4}}) {
    ASSERT_EQ(report.bridges.count(bridge), 1u);
    EXPECT_THAT(report.bridges.at(bridge), IsEmpty());
  }
  EXPECT_THAT(report.crossed, IsEmpty());
}

TEST(ExamineBridges, RejectedPairsContradictTheBridgesThatTheyCross) {
  const ViewPair across_one = {0, 3}, across_both = {1, 6},
                 across_none = {4, 5};
  const BridgeReport report =
      ExamineBridges(TwoTriangles().WithoutPairs({across_none}),
                     {across_one, across_both, across_none});
  EXPECT_THAT(report.bridges.at({2, 3}), ElementsAre(across_one, across_both));
  EXPECT_THAT(report.bridges.at({3, 4}), ElementsAre(across_both));
  // Without 4-5 the triangle is a path: both its pairs are bridges.
  EXPECT_THAT(
      report.crossed,
      ElementsAre(
          Pair(across_one, ElementsAre(ViewPair{2, 3})),
          Pair(across_both,
               ElementsAre(ViewPair{2, 3}, ViewPair{3, 4}, ViewPair{4, 6})),
          Pair(across_none, ElementsAre(ViewPair{4, 6}, ViewPair{5, 6}))));
}

TEST(ViewsBeyond, AreTheSmallerSide) {
  EXPECT_THAT(ViewsBeyond(TwoTriangles(), {2, 3}), ElementsAre(0, 1, 2));
  EXPECT_THAT(ViewsBeyond(TwoTriangles(), {3, 4}), ElementsAre(4, 5, 6));
  const ViewGraph path(std::vector<ViewPair>{{0, 5}, {5, 3}, {3, 4}});
  EXPECT_THAT(ViewsBeyond(path, {3, 5}), ElementsAre(3, 4));
}

TEST(ExamineBridges, RejectedPairsBetweenComponentsCloseNothing) {
  const BridgeReport report = ExamineBridges(
      ViewGraph(std::vector<ViewPair>{{0, 1}, {2, 3}}), {{1, 2}, {0, 9}});
  EXPECT_THAT(report.bridges.at({0, 1}), IsEmpty());
  EXPECT_THAT(report.crossed, IsEmpty());
}

}  // namespace
}  // namespace lowlap
