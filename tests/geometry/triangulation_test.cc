#include "lowlap/geometry/internal/triangulation.h"

#include <gtest/gtest.h>

#include <vector>

#include "geometry/random_geometry.h"
#include "support/matchers.h"
#include "support/random_vectors.h"

namespace lowlap {
namespace {

using testing::LookAt;
using testing::RandomTransform;
using testing::RandomVector;
using testing::VectorNear;

std::vector<RigidTransform> RandomCameras(Random& random, int count) {
  std::vector<RigidTransform> cams_from_world;
  for (int n = 0; n < count; ++n) {
    const Vec3 center = 8 * RandomVector(random).normalized();
    cams_from_world.push_back(LookAt(center, 0.5 * RandomVector(random)));
  }
  return cams_from_world;
}

TEST(RayTriangulator, AreTheDepths) {
  Random random(1);
  for (int n = 0; n < 100; ++n) {
    const RigidTransform cam2_from_cam1 = RandomTransform(random);
    const Vec3 x1 = RandomVector(random);
    const Vec3 x2 = cam2_from_cam1 * x1;
    // Bearings of any length; points behind a camera have negative depth.
    const double s1 = random.Uniform(0.1, 3), s2 = random.Uniform(-3, -0.1);
    const auto depths =
        RayTriangulator(cam2_from_cam1).Depths(x1 / s1, x2 / s2);
    ASSERT_TRUE(depths);
    EXPECT_THAT(*depths, VectorNear(Vec2(s1, s2), 1e-6));
  }
}

TEST(RayTriangulator, MinimiseTheDistanceOfSkewRays) {
  Random random(2);
  for (int n = 0; n < 50; ++n) {
    const RigidTransform cam2_from_cam1 = RandomTransform(random);
    const Vec3 b1 = RandomVector(random), b2 = RandomVector(random);
    const auto depths = RayTriangulator(cam2_from_cam1).Depths(b1, b2);
    ASSERT_TRUE(depths);
    const auto distance = [&](const Vec2& d) {
      return (cam2_from_cam1 * Vec3(d(0) * b1) - d(1) * b2).norm();
    };
    const double least = distance(*depths);
    for (int k = 0; k < 50; ++k) {
      const Vec2 step = testing::GaussianVec2(random, 0.01);
      EXPECT_GE(distance(*depths + step), least - 1e-12);
    }
  }
}

TEST(RayTriangulator, ParallelRaysHaveNone) {
  const RigidTransform cam2_from_cam1{Mat3::Identity(), Vec3(1, 0, 0)};
  EXPECT_FALSE(
      RayTriangulator(cam2_from_cam1).Depths(Vec3(0, 0, 1), Vec3(0, 0, 1)));
  EXPECT_FALSE(
      RayTriangulator(cam2_from_cam1).Depths(Vec3(0, 0, 1), Vec3(0, 0, -2)));
  EXPECT_FALSE(
      RayTriangulator(cam2_from_cam1).Depths(Vec3(0, 0, 0), Vec3(0, 0, 1)));
}

TEST(TriangulateMidpoint, IsExactWithoutNoise) {
  Random random(3);
  for (int n = 0; n < 100; ++n) {
    const auto cams = RandomCameras(random, 2);
    const RigidTransform cam2_from_cam1 = cams[1] * cams[0].Inverse();
    const Vec3 x1 = cams[0] * Vec3(0.3 * RandomVector(random));
    const auto point =
        TriangulateMidpoint(cam2_from_cam1, x1, cam2_from_cam1 * x1);
    ASSERT_TRUE(point);
    EXPECT_THAT(*point, VectorNear(x1, 1e-8));
  }
}

TEST(TriangulateMidpoint, RefusesPointsBehindACamera) {
  const RigidTransform cam2_from_cam1{Mat3::Identity(), Vec3(-1, 0, 0)};
  const Vec3 x1(0.5, 0, 4), x2 = cam2_from_cam1 * x1;
  EXPECT_TRUE(TriangulateMidpoint(cam2_from_cam1, x1, x2));
  EXPECT_FALSE(TriangulateMidpoint(cam2_from_cam1, -x1, x2));
  EXPECT_FALSE(TriangulateMidpoint(cam2_from_cam1, x1, -x2));
  // Diverging rays meet behind both.
  EXPECT_FALSE(
      TriangulateMidpoint(cam2_from_cam1, Vec3(-1, 0, 4), Vec3(1, 0, 4)));
}

}  // namespace
}  // namespace lowlap
