#include "lowlap/geometry/triangulation.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/random_geometry.h"
#include "support/matchers.h"

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

std::vector<Vec3> Images(const std::vector<RigidTransform>& cams_from_world,
                         const Vec3& point) {
  std::vector<Vec3> images;
  for (const RigidTransform& cam_from_world : cams_from_world) {
    const Vec3 in_cam = cam_from_world * point;
    images.push_back(in_cam / in_cam.z());
  }
  return images;
}

double ReprojectionError(const std::vector<RigidTransform>& cams_from_world,
                         const std::vector<Vec3>& bearings, const Vec3& point) {
  double sum = 0;
  const std::vector<Vec3> images = Images(cams_from_world, point);
  for (std::size_t n = 0; n < images.size(); ++n) {
    sum += (images[n] - bearings[n]).squaredNorm();
  }
  return sum;
}

TEST(RayDepths, AreTheDepths) {
  Random random(1);
  for (int n = 0; n < 100; ++n) {
    const RigidTransform cam2_from_cam1 = RandomTransform(random);
    const Vec3 x1 = RandomVector(random);
    const Vec3 x2 = cam2_from_cam1 * x1;
    // Bearings of any length; points behind a camera have negative depth.
    const double s1 = random.Uniform(0.1, 3), s2 = random.Uniform(-3, -0.1);
    const auto depths = RayDepths(cam2_from_cam1, x1 / s1, x2 / s2);
    ASSERT_TRUE(depths);
    EXPECT_THAT(*depths, VectorNear(Vec2(s1, s2), 1e-6));
  }
}

TEST(RayDepths, MinimiseTheDistanceOfSkewRays) {
  Random random(2);
  for (int n = 0; n < 50; ++n) {
    const RigidTransform cam2_from_cam1 = RandomTransform(random);
    const Vec3 b1 = RandomVector(random), b2 = RandomVector(random);
    const auto depths = RayDepths(cam2_from_cam1, b1, b2);
    ASSERT_TRUE(depths);
    const auto distance = [&](const Vec2& d) {
      return (cam2_from_cam1 * Vec3(d(0) * b1) - d(1) * b2).norm();
    };
    const double least = distance(*depths);
    for (int k = 0; k < 50; ++k) {
      const Vec2 step(random.Gaussian(0.01), random.Gaussian(0.01));
      EXPECT_GE(distance(*depths + step), least - 1e-12);
    }
  }
}

TEST(RayDepths, ParallelRaysHaveNone) {
  const RigidTransform cam2_from_cam1{Mat3::Identity(), Vec3(1, 0, 0)};
  EXPECT_FALSE(RayDepths(cam2_from_cam1, Vec3(0, 0, 1), Vec3(0, 0, 1)));
  EXPECT_FALSE(RayDepths(cam2_from_cam1, Vec3(0, 0, 1), Vec3(0, 0, -2)));
  EXPECT_FALSE(RayDepths(cam2_from_cam1, Vec3(0, 0, 0), Vec3(0, 0, 1)));
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

TEST(TriangulatePoint, IsExactWithoutNoise) {
  Random random(4);
  for (int count = 2; count <= 8; ++count) {
    for (int n = 0; n < 30; ++n) {
      const auto cams = RandomCameras(random, count);
      const Vec3 truth = 0.7 * RandomVector(random);
      const auto point = TriangulatePoint(cams, Images(cams, truth));
      ASSERT_TRUE(point);
      EXPECT_THAT(*point, VectorNear(truth, 1e-8));
    }
  }
}

TEST(TriangulatePoint, MinimisesTheReprojectionErrorUnderNoise) {
  Random random(5);
  for (int n = 0; n < 50; ++n) {
    const auto cams = RandomCameras(random, 4);
    auto bearings = Images(cams, 0.5 * RandomVector(random));
    for (Vec3& bearing : bearings) {
      bearing += Vec3(random.Gaussian(2e-3), random.Gaussian(2e-3), 0);
    }
    const auto point = TriangulatePoint(cams, bearings);
    ASSERT_TRUE(point);
    const double least = ReprojectionError(cams, bearings, *point);
    for (int k = 0; k < 50; ++k) {
      const Vec3 other = *point + 1e-3 * RandomVector(random);
      EXPECT_GE(ReprojectionError(cams, bearings, other), least);
    }
  }
}

TEST(TriangulatePoint, IsIndependentOfTheWorldFrame) {
  Random random(6);
  auto cams = RandomCameras(random, 3);
  auto bearings = Images(cams, Vec3(0.1, -0.2, 0.3));
  for (Vec3& bearing : bearings) bearing.x() += random.Gaussian(1e-3);
  const auto point = TriangulatePoint(cams, bearings);
  const RigidTransform world_from_other = RandomTransform(random);
  for (RigidTransform& cam : cams) cam = cam * world_from_other;
  const auto other = TriangulatePoint(cams, bearings);
  ASSERT_TRUE(point && other);
  EXPECT_THAT(world_from_other * *other, VectorNear(*point, 1e-9));
}

TEST(TriangulatePoint, Refuses) {
  const RigidTransform cam1, cam2{Mat3::Identity(), Vec3(-1, 0, 0)};
  const Vec3 ahead(0, 0, 1);
  EXPECT_FALSE(TriangulatePoint({cam1}, {ahead}));
  EXPECT_FALSE(TriangulatePoint({cam1, cam2}, {ahead}));
  EXPECT_FALSE(TriangulatePoint({cam1, cam2}, {ahead, ahead}));  // parallel
  EXPECT_FALSE(TriangulatePoint({cam1, cam1}, {ahead, ahead}));  // one centre
  EXPECT_FALSE(TriangulatePoint(
      {cam1, cam2}, {Vec3(-0.2, 0, 1), Vec3(0.2, 0, 1)}));  // behind
}

TEST(TriangulateLine, IsExactWithoutNoise) {
  Random random(7);
  for (int count = 2; count <= 6; ++count) {
    for (int n = 0; n < 30; ++n) {
      const auto cams = RandomCameras(random, count);
      const PluckerLine truth = PluckerLine::FromPoints(
          0.7 * RandomVector(random), 0.7 * RandomVector(random));
      std::vector<Vec3> normals;
      for (const RigidTransform& cam : cams) {
        const double sign = random.Uniform() < 0.5 ? -1 : 1;
        normals.push_back(sign * (cam * truth).moment.normalized());
      }
      const auto line = TriangulateLine(cams, normals);
      ASSERT_TRUE(line);
      EXPECT_LT(line->direction.cross(truth.direction).norm(), 1e-6);
      EXPECT_NEAR(
          (line->ClosestPointTo(Vec3::Zero()) - truth.FootPoint()).norm(), 0,
          1e-5);
    }
  }
}

TEST(TriangulateLine, TwoViewsAgreeWithTheClosedForm) {
  Random random(8);
  for (int n = 0; n < 50; ++n) {
    const RigidTransform cam1, cam2_from_cam1 = RandomTransform(random);
    const Vec3 l1 = RandomVector(random).normalized();
    const Vec3 l2 = RandomVector(random).normalized();
    const auto expected = LineFromTwoViews(cam2_from_cam1, l1, l2);
    const auto line = TriangulateLine({cam1, cam2_from_cam1}, {l1, l2});
    ASSERT_TRUE(expected && line);
    const double sign = line->direction.dot(expected->direction) > 0 ? 1 : -1;
    EXPECT_THAT(Vec3(sign * line->direction),
                VectorNear(expected->direction, 1e-6));
    EXPECT_THAT(
        Vec3(sign * line->moment),
        VectorNear(expected->moment, 1e-5 * (1 + expected->moment.norm())));
  }
}

TEST(TriangulateLine, Refuses) {
  const RigidTransform cam1, cam2{Mat3::Identity(), Vec3(-1, 0, 0)},
      cam3{Mat3::Identity(), Vec3(-2, 0, 0)};
  // All in the epipolar plane y = 0.
  EXPECT_FALSE(TriangulateLine({cam1, cam2, cam3},
                               {Vec3::UnitY(), Vec3::UnitY(), Vec3::UnitY()}));
  EXPECT_FALSE(TriangulateLine({cam1}, {Vec3::UnitY()}));
  EXPECT_FALSE(TriangulateLine({cam1, cam2}, {Vec3::UnitY()}));
  const Vec3 tilted = Vec3(0, 1, 0.01).normalized();
  EXPECT_TRUE(TriangulateLine({cam1, cam2}, {Vec3::UnitY(), tilted}, 0.005));
  EXPECT_FALSE(TriangulateLine({cam1, cam2}, {Vec3::UnitY(), tilted}, 0.02));
}

TEST(TriangulationAngle, IsTheLargest) {
  const auto at = [](const Vec3& center) {
    return RigidTransform::FromRotationAndCenter(Mat3::Identity(), center);
  };
  const Vec3 point(0, 0, 1);
  EXPECT_NEAR(TriangulationAngle({at({0, 0, 0}), at({1, 0, 0})}, point),
              kPi / 4, 1e-12);
  EXPECT_NEAR(
      TriangulationAngle({at({0, 0, 0}), at({1, 0, 0}), at({-1, 0, 0})}, point),
      kPi / 2, 1e-12);
  EXPECT_EQ(TriangulationAngle({at({0, 0, 0})}, point), 0);
}

}  // namespace
}  // namespace lowlap
