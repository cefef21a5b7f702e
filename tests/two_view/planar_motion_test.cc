#include "lowlap/two_view/internal/planes/planar_motion.h"

#include <gtest/gtest.h>

#include <numeric>

#include "tests/support/random_vectors.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::DirectionErrorDeg;
using testing::kPlaneNormal;
using testing::MakeTwoViewScene;
using testing::RotationErrorDeg;
using testing::TwoViewSceneOptions;

TEST(OtherPlanarMotion, MovesThePlaneLikeTheGivenOne) {
  Random random(1);
  for (int trial = 0; trial < 300; ++trial) {
    const auto uniform = [&](double size) {
      return testing::UniformVec3(random, {-size, -size, -size},
                                  {size, size, size});
    };
    const RigidTransform motion{RotationFromAngleAxis(uniform(0.5)),
                                uniform(1).normalized()};
    const Vec3 normal = (Vec3::UnitZ() + uniform(0.6)) / 6;
    const auto other = OtherPlanarMotion(motion, normal, Vec3::UnitZ());
    ASSERT_TRUE(other);
    EXPECT_GT(RotationErrorDeg(other->rotation, motion.rotation) +
                  DirectionErrorDeg(other->translation, motion.translation),
              1e-3);
    EXPECT_LT(RotationDefect(other->rotation), 1e-12);
    // Every point of the plane keeps its epipolar constraint.
    const Mat3 homography =
        motion.rotation + motion.translation * normal.transpose();
    for (int n = 0; n < 5; ++n) {
      const Vec3 x1 =
          testing::UniformVec2(random, {-0.5, -0.5}, {0.5, 0.5}).homogeneous();
      const Vec3 x2 = homography * x1;
      EXPECT_NEAR(
          x2.dot(other->translation.cross(other->rotation * x1)) / x2.norm(), 0,
          1e-8);
    }
    // And back again.
    const Mat3 back = homography - other->rotation;
    const Vec3 other_normal = back.transpose() * other->translation;
    const auto again = OtherPlanarMotion(*other, other_normal, Vec3::UnitZ());
    ASSERT_TRUE(again);
    EXPECT_LT(RotationErrorDeg(again->rotation, motion.rotation), 1e-4);
    EXPECT_LT(DirectionErrorDeg(again->translation, motion.translation), 1e-4);
  }
}

TEST(OtherPlanarMotion, ThereIsNoneForTranslationAlongTheNormal) {
  const RigidTransform motion{Mat3::Identity(), Vec3::UnitZ()};
  EXPECT_FALSE(OtherPlanarMotion(motion, Vec3::UnitZ() / 5, Vec3::UnitZ()));
}

TEST(DominantPlane, FindsThePlaneAmongOtherPoints) {
  TwoViewSceneOptions options;
  options.planar = true;
  options.num_right = 200;
  options.num_off_plane = 80;
  options.noise_px = 0.3;
  const auto scene = MakeTwoViewScene(options, 2);
  std::vector<int> all(scene.matches.size());
  std::iota(all.begin(), all.end(), 0);
  Random random(3);
  const auto plane =
      DominantPlane(scene.cam2_from_cam1, scene.Pairs(), all, 1.5, random);
  ASSERT_TRUE(plane);
  EXPECT_LT(DirectionErrorDeg(plane->normal, kPlaneNormal), 1);
  EXPECT_NEAR(plane->normal.norm(), kPlaneNormal.norm(),
              0.01 * kPlaneNormal.norm());
  int on_plane = 0;
  for (const int i : plane->inliers) on_plane += i >= 80;
  EXPECT_GE(on_plane, 115);
  EXPECT_LE(static_cast<int>(plane->inliers.size()) - on_plane, 8);
}

TEST(DominantPlane, NeedsFourMatches) {
  const auto scene = MakeTwoViewScene({}, 4);
  Random random(5);
  EXPECT_FALSE(DominantPlane(scene.cam2_from_cam1, scene.Pairs(), {0, 1, 2},
                             1.0, random));
}

}  // namespace
}  // namespace lowlap
