#include "lowlap/adjustment/internal/planes/scene_planes.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

#include "tests/adjustment/planes_fixture.h"
#include "tests/support/matchers.h"

namespace lowlap {
namespace {

using ::testing::Each;
using ::testing::Field;
using ::testing::IsEmpty;
using testing::IsOk;
using ::testing::Le;
using ::testing::Not;
using ::testing::SizeIs;

constexpr double kStddev = PlaneLandmarks::kStddev;

std::vector<PlaneState> Find(const PlaneLandmarks& landmarks) {
  const auto planes = FindPlanes(landmarks.landmarks(), {});
  EXPECT_THAT(planes, IsOk());
  return *planes;
}

// A floor that two pairs of views see, the second one `off` from where it is.
PlaneLandmarks FloorOfTwoPairs(double off) {
  PlaneLandmarks landmarks(1);
  for (int n = 0; n < 100; ++n) landmarks.AddPoint(landmarks.OnFloor(1));
  for (int n = 0; n < 50; ++n) landmarks.AddPoint(landmarks.InCloud());
  landmarks.SeenFrom({1, 2});
  for (int n = 0; n < 60; ++n) landmarks.AddPoint(landmarks.OnFloor(1 + off));
  return landmarks;
}

double LoosestTie(const PlaneState& plane) {
  double loosest = 0;
  for (const PlaneTie& tie : plane.points) {
    loosest = std::max(loosest, tie.looseness * plane.thickness);
  }
  return loosest;
}

TEST(FindPlanes, FacetsOfDifferentPairsAreOnePlane) {
  const std::vector<PlaneState> planes = Find(FloorOfTwoPairs(0));
  ASSERT_THAT(planes, SizeIs(1));
  EXPECT_GE(planes[0].points.size(), 158U);
  EXPECT_LT(LoosestTie(planes[0]), 2 * kStddev);
  const double height =
      planes[0].anchor.z() + planes[0].offset * planes[0].normal.z();
  EXPECT_NEAR(height, 1, kStddev);
}

// Ties to a wall hold to what it bows to.
TEST(FindPlanes, ABowedWallBowsItsPlane) {
  PlaneLandmarks landmarks(1);
  for (int n = 0; n < 200; ++n) {
    Vec3 point = landmarks.OnFloor(1);
    point.z() += 0.01 * point.x() * point.x();
    landmarks.AddPoint(point);
  }
  for (int n = 0; n < 50; ++n) landmarks.AddPoint(landmarks.InCloud());
  const std::vector<PlaneState> planes = Find(landmarks);
  ASSERT_THAT(planes, Not(IsEmpty()));
  const PlaneState& plane = planes.front();
  const double bow = 4 * plane.bend(0, 0) * plane.normal.z();
  EXPECT_NEAR(bow, 0.04, 0.01);
  EXPECT_NEAR(4 * plane.bend(1, 1) * plane.normal.z(), 0, 0.01);
}

// By less than drift may leave, by far more than the floor is thick.
TEST(FindPlanes, AFacetThatDriftedIsTiedLoosely) {
  constexpr double kOff = 0.05;
  const std::vector<PlaneState> planes = Find(FloorOfTwoPairs(kOff));
  ASSERT_THAT(planes, SizeIs(1));
  EXPECT_GE(planes[0].points.size(), 155U);
  EXPECT_GT(LoosestTie(planes[0]), 0.4 * kOff);
  EXPECT_LT(LoosestTie(planes[0]), kOff);
}

TEST(FindPlanes, WhatIsFarApartStaysApart) {
  EXPECT_THAT(Find(FloorOfTwoPairs(0.5)), SizeIs(2));
}

TEST(FindPlanes, LandmarksOfThinPairsJoin) {
  // A rough floor: what joins it must be known as well as it is thick.
  PlaneLandmarks landmarks(3);
  Random random(5);
  for (int n = 0; n < 100; ++n) {
    landmarks.AddPoint(landmarks.OnFloor(1 + 0.01 * random.Gaussian()));
    landmarks.AddPoint(landmarks.InCloud());
  }
  landmarks.SeenFrom({1, 2});
  for (int n = 0; n < 3; ++n) {
    landmarks.AddLine(landmarks.OnFloor(1), landmarks.OnFloor(1));
  }
  landmarks.AddLine(landmarks.InCloud(), landmarks.InCloud());
  const std::vector<PlaneState> planes = Find(landmarks);
  ASSERT_THAT(planes, SizeIs(1));
  EXPECT_THAT(planes[0].lines, SizeIs(3));
  EXPECT_THAT(planes[0].lines, Each(Field(&PlaneTie::landmark, Le(2))));
}

TEST(FindPlanes, DoNotJoinWhatNothingElseJoins) {
  PlaneLandmarks landmarks(1);
  for (int n = 0; n < 50; ++n) landmarks.AddPoint(landmarks.OnFloor(1));
  for (int n = 0; n < 50; ++n) landmarks.AddPoint(landmarks.InCloud());
  landmarks.SeenFrom({2, 3});
  for (int n = 0; n < 50; ++n) landmarks.AddPoint(landmarks.OnFloor(1));
  EXPECT_THAT(Find(landmarks), SizeIs(2));
}

// What three views see is in the facets of three pairs.
TEST(FindPlanes, ALandmarkIsTiedOnce) {
  PlaneLandmarks landmarks(2);
  landmarks.SeenFrom({0, 1, 2});
  for (int n = 0; n < 50; ++n) {
    landmarks.AddPoint(landmarks.OnFloor(1));
    landmarks.AddPoint(landmarks.InCloud());
  }
  const std::vector<PlaneState> planes = Find(landmarks);
  ASSERT_THAT(planes, SizeIs(1));
  EXPECT_LE(planes[0].points.size(), 55U);
}

}  // namespace
}  // namespace lowlap
