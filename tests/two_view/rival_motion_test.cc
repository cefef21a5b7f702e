#include "lowlap/two_view/internal/evidence/rival_motion.h"

#include <gtest/gtest.h>

#include "tests/two_view/copied_pair.h"

namespace lowlap {
namespace {

using testing::Anything;
using testing::CopiedPair;
using testing::Copy;
using testing::Door;
using testing::Resembling;
using testing::UniformVec3;

// Three times as far as the match.
Copy AnotherDoor(const Vec3& point, PointDescriptor look, Random* random) {
  for (int n = 0; n < 16; ++n) look = Resembling(look, random);
  return {point + testing::Step(), look};
}

Copy Anywhere(const Vec3& /*point*/, const PointDescriptor& look,
              Random* random) {
  const Vec3 point = UniformVec3(*random, {-1, -1, 3}, {1, 1, 9});
  return {point, Resembling(look, random)};
}

double Log10Nfa(const CopiedPair& pair) {
  return Log10NfaOfRivalMotion(pair.view1.View(), pair.view2.View(), pair.pose,
                               pair.pose.point_inliers);
}

TEST(Log10NfaOfRivalMotion, CopiesOneStepOnBearOutAnotherMotion) {
  const CopiedPair pair(Door);
  EXPECT_LT(Log10Nfa(pair), -40);
  EXPECT_EQ(Log10Nfa(pair), Log10Nfa(pair));
}

TEST(Log10NfaOfRivalMotion, EitherViewMayShowTheCopies) {
  const CopiedPair pair(Door);
  RelativePose swapped;
  swapped.rotation = pair.pose.rotation.transpose();
  swapped.direction = -(swapped.rotation * pair.pose.direction);
  swapped.point_threshold_px = 1;
  for (const FeatureMatch& match : pair.pose.point_inliers) {
    swapped.point_inliers.push_back({match.second, match.first});
  }
  EXPECT_LT(Log10NfaOfRivalMotion(pair.view2.View(), pair.view1.View(), swapped,
                                  swapped.point_inliers),
            -40);
}

TEST(Log10NfaOfRivalMotion, WhatDoesNotLookAlikeBearsOutNone) {
  EXPECT_EQ(Log10Nfa(CopiedPair(Anything)), 0);
}

TEST(Log10NfaOfRivalMotion, WhatLooksALittleAlikeBearsOutNone) {
  EXPECT_EQ(Log10Nfa(CopiedPair(AnotherDoor)), 0);
}

TEST(Log10NfaOfRivalMotion, CopiesHereAndThereAgreeOnNone) {
  EXPECT_GT(Log10Nfa(CopiedPair(Anywhere)), -2);
}

// Along an edge that the camera moves along, any place is on the epipolar line.
TEST(Log10NfaOfRivalMotion, PointsOfOneEdgeAgreeByChance) {
  const CopiedPair pair(
      [](const Vec3& point, const PointDescriptor& look, Random* random) {
        return Copy{Vec3(random->Uniform(-1, 1), point.y(), point.z()),
                    Resembling(look, random)};
      },
      {Mat3::Identity(), Vec3(-0.5, 0, 0)}, {-1, 0.495, 4}, {1, 0.505, 4});
  EXPECT_GT(Log10Nfa(pair), -2);
}

TEST(Log10NfaOfRivalMotion, NothingIsNoEvidence) {
  CopiedPair pair(Door);
  pair.pose.point_inliers.clear();
  EXPECT_EQ(Log10Nfa(pair), 0);
  pair.pose.point_inliers.push_back({0, 0});
  EXPECT_EQ(Log10Nfa(pair), 0);
}

}  // namespace
}  // namespace lowlap
