#include "lowlap/geometry/internal/rotation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "geometry/random_geometry.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::RandomRotation;
using testing::RandomVector;
using testing::VectorNear;

TEST(Rotation, CrossMatrixIsTheCrossProduct) {
  const Vec3 v(1, -2, 3), w(0.5, 4, -1);
  EXPECT_EQ(Vec3(CrossMatrix(v) * w), v.cross(w));
}

TEST(Rotation, ExponentialAgreesWithItsSeries) {
  Random random(1);
  for (int n = 0; n < 50; ++n) {
    const Vec3 w = 0.7 * RandomVector(random);
    Mat3 series = Mat3::Identity(), term = Mat3::Identity();
    for (int k = 1; k < 40; ++k) {
      term = term * CrossMatrix(w) / k;
      series += term;
    }
    EXPECT_LT((RotationFromAngleAxis(w) - series).norm(), 1e-12);
  }
}

TEST(Rotation, AngleAxisGoesBothWaysAtEveryAngle) {
  Random random(2);
  for (const double angle : {0.0, 1e-300, 1e-15, 1e-9, 1e-4, 0.1, 1.0, 2.0, 3.0,
                             kPi - 1e-4, kPi - 1e-8}) {
    for (int n = 0; n < 20; ++n) {
      const Vec3 w = angle * RandomVector(random).normalized();
      const Mat3 rotation = RotationFromAngleAxis(w);
      EXPECT_LT(RotationDefect(rotation), 1e-14);
      EXPECT_THAT(AngleAxisFromRotation(rotation),
                  VectorNear(w, 1e-9 * angle + 1e-16))
          << angle;
    }
  }
}

TEST(Rotation, HalfTurnHasAnAxisOfEitherSign) {
  const Vec3 axis = Vec3(1, 2, -2) / 3;
  const Vec3 w = AngleAxisFromRotation(RotationFromAngleAxis(kPi * axis));
  EXPECT_NEAR(w.norm(), kPi, 1e-12);
  EXPECT_NEAR(std::abs(w.dot(axis)), kPi, 1e-12);
}

TEST(Rotation, AngleBetweenRotationsIsThatOfTheirQuotient) {
  Random random(3);
  for (const double angle : {1e-12, 1e-6, 0.5, 3.0}) {
    const Mat3 a = RandomRotation(random);
    const Mat3 b =
        a * RotationFromAngleAxis(angle * RandomVector(random).normalized());
    EXPECT_NEAR(RotationAngleBetween(a, b), angle,
                1e-15 + 1e-9 * angle + 1e-15);
    EXPECT_NEAR(RotationAngleBetween(b, a), angle, 1e-9 * angle + 2e-15);
  }
}

TEST(Rotation, AngleBetweenVectorsIsAccurateAtTheEnds) {
  const Vec3 a(3, 0, 0);
  EXPECT_NEAR(AngleBetween(a, Vec3(1, 1e-10, 0)), 1e-10, 1e-20);
  EXPECT_NEAR(kPi - AngleBetween(a, Vec3(-1, 1e-10, 0)), 1e-10, 1e-15);
  EXPECT_NEAR(AngleBetween(a, Vec3(0, 0, 7)), kPi / 2, 1e-15);
  EXPECT_EQ(AngleBetween(a, a), 0);
}

TEST(Rotation, NearestRotationBeatsItsNeighbours) {
  Random random(4);
  for (int n = 0; n < 50; ++n) {
    Mat3 m;
    for (int k = 0; k < 9; ++k) m(k / 3, k % 3) = random.Gaussian();
    const Mat3 nearest = NearestRotation(m);
    ASSERT_LT(RotationDefect(nearest), 1e-13);
    for (int k = 0; k < 50; ++k) {
      const Mat3 other =
          nearest * RotationFromAngleAxis(0.2 * RandomVector(random));
      EXPECT_LE((nearest - m).norm(), (other - m).norm());
    }
  }
}

TEST(Rotation, NearestRotationOfAReflectionIsARotation) {
  const Mat3 reflection = Vec3(1, 1, -0.5).asDiagonal();
  EXPECT_LT(RotationDefect(NearestRotation(reflection)), 1e-14);
}

TEST(Rotation, DefectNamesWhatIsNoRotation) {
  const Mat3 identity = Mat3::Identity();
  EXPECT_EQ(RotationDefect(identity), 0);
  EXPECT_NEAR(RotationDefect(1.001 * identity), 0.002001, 1e-9);
  Mat3 mirrored = identity;
  mirrored(2, 2) = -1;
  EXPECT_EQ(RotationDefect(mirrored), std::numeric_limits<double>::infinity());
  Mat3 broken = identity;
  broken(0, 1) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(RotationDefect(broken), std::numeric_limits<double>::infinity());
}

TEST(Rotation, TangentBasisCompletesTheFrame) {
  Random random(5);
  for (int n = 0; n < 50; ++n) {
    const Vec3 d = RandomVector(random).normalized();
    Mat3 frame;
    frame << TangentBasis(d), d;
    EXPECT_LT(RotationDefect(frame), 1e-14);
  }
}

TEST(RigidTransform, ComposesAndInverts) {
  Random random(6);
  for (int n = 0; n < 20; ++n) {
    const RigidTransform b_from_a = testing::RandomTransform(random);
    const RigidTransform c_from_b = testing::RandomTransform(random);
    const Vec3 x = RandomVector(random);
    EXPECT_THAT((c_from_b * b_from_a) * x,
                VectorNear(Vec3(c_from_b * (b_from_a * x)), 1e-13));
    EXPECT_THAT(b_from_a.Inverse() * (b_from_a * x), VectorNear(x, 1e-13));
    EXPECT_THAT(b_from_a * b_from_a.Center(), VectorNear(Vec3(0, 0, 0), 1e-13));
    EXPECT_THAT(Vec3(b_from_a.Matrix() * x.homogeneous()),
                VectorNear(Vec3(b_from_a * x), 1e-13));
    const RigidTransform again = RigidTransform::FromRotationAndCenter(
        b_from_a.rotation, b_from_a.Center());
    EXPECT_THAT(again.translation, VectorNear(b_from_a.translation, 1e-13));
  }
}

}  // namespace
}  // namespace lowlap
