#include "lowlap/geometry/internal/epipolar.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/random_geometry.h"
#include "support/matchers.h"
#include "support/random_vectors.h"

namespace lowlap {
namespace {

using testing::RandomTransform;
using testing::RandomVector;

Vec3 Dehomogenized(const Vec3& x) { return x / x.z(); }

TEST(Essential, HoldsForProjectionsOfOnePoint) {
  Random random(1);
  for (int n = 0; n < 100; ++n) {
    const RigidTransform cam2_from_cam1 = RandomTransform(random);
    const Mat3 essential = EssentialFromPose(cam2_from_cam1);
    const Vec3 x1 = RandomVector(random);
    const Vec3 x2 = cam2_from_cam1 * x1;
    EXPECT_NEAR(x2.dot(essential * x1), 0, 1e-12);
    const double squared =
        SampsonSquared(essential, Dehomogenized(x1), Dehomogenized(x2));
    EXPECT_NEAR(squared, 0, 1e-20);
  }
}

TEST(Sampson, DoesNotDependOnTheScaleOfE) {
  Random random(2);
  const Mat3 essential = EssentialFromPose(RandomTransform(random));
  const Vec3 x1(0.1, 0.2, 1), x2(-0.3, 0.1, 1);
  const double squared = SampsonSquared(essential, x1, x2);
  EXPECT_GT(squared, 0);
  EXPECT_NEAR(SampsonSquared(-7 * essential, x1, x2), squared, 1e-14 * squared);
  EXPECT_NEAR(SampsonSquared(essential.transpose(), x2, x1), squared,
              1e-14 * squared);
}

// To first order it is the squared distance in R^4 to the nearest exact match;
// that distance is found by constrained Newton steps.
TEST(Sampson, ApproximatesTheReprojectionError) {
  Random random(3);
  for (int n = 0; n < 200; ++n) {
    const RigidTransform cam2_from_cam1{
        RotationFromAngleAxis(0.2 * RandomVector(random)),
        RandomVector(random).normalized()};
    const Mat3 essential = EssentialFromPose(cam2_from_cam1);
    const Vec3 in_cam1 = Vec3(0, 0, 6) + RandomVector(random);
    Vec3 x1 = Dehomogenized(in_cam1);
    Vec3 x2 = Dehomogenized(cam2_from_cam1 * in_cam1);
    // Far from the epipoles, where the constraint is almost linear.
    if ((essential * x1).head<2>().norm() < 0.1) continue;
    const double noise = 1e-4;
    x1.head<2>() += testing::GaussianVec2(random, noise);
    x2.head<2>() += testing::GaussianVec2(random, noise);
    Vec3 y1 = x1, y2 = x2;
    for (int iteration = 0; iteration < 20; ++iteration) {
      const Vec2 g1 = (essential.transpose() * y2).head<2>();
      const Vec2 g2 = (essential * y1).head<2>();
      const double constraint = y2.dot(essential * y1) +
                                g1.dot((x1 - y1).head<2>()) +
                                g2.dot((x2 - y2).head<2>());
      const double step = constraint / (g1.squaredNorm() + g2.squaredNorm());
      y1.head<2>() = x1.head<2>() - step * g1;
      y2.head<2>() = x2.head<2>() - step * g2;
    }
    ASSERT_NEAR(y2.dot(essential * y1), 0, 1e-14);
    const double exact = (x1 - y1).squaredNorm() + (x2 - y2).squaredNorm();
    EXPECT_NEAR(SampsonSquared(essential, x1, x2), exact, 0.01 * exact + 1e-16);
  }
}

TEST(Sampson, BothEpipolesSayNothing) {
  // Forward motion: the epipole is the image centre of both.
  const Mat3 essential = EssentialFromPose({Mat3::Identity(), Vec3(0, 0, -1)});
  EXPECT_EQ(SampsonSquared(essential, Vec3::UnitZ(), Vec3::UnitZ()), 0);
}

}  // namespace
}  // namespace lowlap
