#include "lowlap/two_view/internal/search/same_pose.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

TEST(SamePose, LooksAtRotationAndDirection) {
  const RigidTransform pose{Mat3::Identity(), Vec3::UnitX()};
  RigidTransform other = pose;
  EXPECT_TRUE(SamePose(pose, other));
  other.rotation = RotationFromAngleAxis(Vec3(0, 0, RadFromDeg(0.6)));
  EXPECT_FALSE(SamePose(pose, other));
  other = pose;
  other.translation = Vec3(1, std::tan(RadFromDeg(2.5)), 0).normalized();
  EXPECT_FALSE(SamePose(pose, other));
  EXPECT_TRUE(SamePose(pose, other, 0.7));
}

}  // namespace
}  // namespace lowlap
