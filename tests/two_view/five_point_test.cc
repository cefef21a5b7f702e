#include "lowlap/two_view/internal/kernels/five_point.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/epipolar.h"
#include "lowlap/geometry/internal/rotation.h"
#include "support/random_vectors.h"

namespace lowlap {
namespace {

enum class Setup { kGeneral, kPlanar, kForward, kBackward, kSideways };

struct Problem {
  FivePoints x1;
  FivePoints x2;
  RigidTransform truth;
};

Problem MakeProblem(Setup setup, Random& random) {
  Problem p;
  const auto uniform = [&](double size) {
    return testing::UniformVec3(random, {-size, -size, -size},
                                {size, size, size});
  };
  p.truth.rotation = RotationFromAngleAxis(uniform(0.5));
  p.truth.translation = uniform(1).normalized();
  if (setup == Setup::kForward || setup == Setup::kBackward) {
    p.truth.rotation = Mat3::Identity();
    p.truth.translation =
        Vec3::UnitZ() * (setup == Setup::kForward ? -1.0 : 1.0);
  } else if (setup == Setup::kSideways) {
    p.truth.rotation = Mat3::Identity();
    p.truth.translation = Vec3::UnitX();
  }
  const Vec3 normal =
      testing::UniformVec2(random, {-0.5, -0.5}, {0.5, 0.5}).homogeneous();
  for (int n = 0; n < 5; ++n) {
    const Vec3 x1 =
        testing::UniformVec2(random, {-0.5, -0.5}, {0.5, 0.5}).homogeneous();
    const double depth =
        setup == Setup::kPlanar ? 6 / normal.dot(x1) : random.Uniform(3, 9);
    p.x1[n] = x1;
    p.x2[n] = p.truth * (depth * x1);
  }
  return p;
}

double Distance(const Mat3& a, const Mat3& b) {
  return std::min((a - b).norm(), (a + b).norm());
}

class FivePointTest : public ::testing::TestWithParam<Setup> {};

TEST_P(FivePointTest, HasTheTrueMatrixAmongItsRoots) {
  Random random(100 + static_cast<int>(GetParam()));
  constexpr int kNumProblems = 3000;
  int missed = 0;
  for (int trial = 0; trial < kNumProblems; ++trial) {
    const Problem p = MakeProblem(GetParam(), random);
    const Mat3 truth = EssentialFromPose(p.truth);
    double best = 1;
    const auto essentials = EssentialFromFivePoints(p.x1, p.x2);
    EXPECT_LE(essentials.size(), 10u);
    for (const Mat3& e : essentials) best = std::min(best, Distance(e, truth));
    missed += best > 1e-8;
  }
  // Near a double root (a critical configuration) a root may be lost.
  EXPECT_LE(missed, 2);
}

TEST_P(FivePointTest, ReturnsOnlyEssentialMatricesOfThePoints) {
  Random random(200 + static_cast<int>(GetParam()));
  for (int trial = 0; trial < 500; ++trial) {
    const Problem p = MakeProblem(GetParam(), random);
    for (const Mat3& e : EssentialFromFivePoints(p.x1, p.x2)) {
      EXPECT_NEAR(e.norm(), std::sqrt(2.0), 1e-12);
      EXPECT_NEAR(e.determinant(), 0, 1e-9);
      EXPECT_LT((2 * e * e.transpose() * e - 2 * e).norm(), 1e-8);
      for (int n = 0; n < 5; ++n) {
        EXPECT_NEAR(p.x2[n].normalized().dot(e * p.x1[n].normalized()), 0,
                    1e-12);
      }
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Setups, FivePointTest,
                         ::testing::Values(Setup::kGeneral, Setup::kPlanar,
                                           Setup::kForward, Setup::kBackward,
                                           Setup::kSideways));

TEST(FivePoint, DoesNotDependOnTheScaleOfTheRays) {
  Random random(5);
  const Problem p = MakeProblem(Setup::kGeneral, random);
  FivePoints scaled = p.x1;
  for (int n = 0; n < 5; ++n) scaled[n] *= (n % 2 == 0 ? -1 : 1) * (n + 1);
  const auto a = EssentialFromFivePoints(p.x1, p.x2);
  const auto b = EssentialFromFivePoints(scaled, p.x2);
  ASSERT_EQ(a.size(), b.size());
  for (const Mat3& e : a) {
    double best = 1;
    for (const Mat3& other : b) best = std::min(best, Distance(e, other));
    EXPECT_LT(best, 1e-9);
  }
}

void ExpectNoGarbage(const FivePoints& x1, const FivePoints& x2) {
  for (const Mat3& e : EssentialFromFivePoints(x1, x2)) {
    EXPECT_TRUE(e.allFinite());
    EXPECT_LT((2 * e * e.transpose() * e - 2 * e).norm(), 1e-6);
    for (int n = 0; n < 5; ++n) {
      EXPECT_NEAR(x2[n].normalized().dot(e * x1[n].normalized()), 0, 1e-9);
    }
  }
}

TEST(FivePoint, RepeatedPointGivesNoSolution) {
  Random random(6);
  Problem p = MakeProblem(Setup::kGeneral, random);
  p.x1[4] = p.x1[0];
  p.x2[4] = p.x2[0];
  EXPECT_TRUE(EssentialFromFivePoints(p.x1, p.x2).empty());
}

TEST(FivePoint, CollinearPointsGiveNoSolution) {
  Random random(7);
  Problem p = MakeProblem(Setup::kGeneral, random);
  for (int n = 0; n < 5; ++n) {
    const Vec3 x = Vec3(-1, 0.3, 5) + 0.4 * n * Vec3(1, 0.2, 0.5);
    p.x1[n] = x;
    p.x2[n] = p.truth * x;
  }
  EXPECT_TRUE(EssentialFromFivePoints(p.x1, p.x2).empty());
}

TEST(FivePoint, ZeroBaselineGivesNoGarbage) {
  Random random(8);
  for (int trial = 0; trial < 200; ++trial) {
    Problem p = MakeProblem(Setup::kGeneral, random);
    for (int n = 0; n < 5; ++n) p.x2[n] = p.truth.rotation * p.x1[n];
    ExpectNoGarbage(p.x1, p.x2);
  }
}

TEST(FivePoint, ZeroAndNonFinitePointsGiveNoGarbage) {
  Random random(9);
  Problem p = MakeProblem(Setup::kGeneral, random);
  const Vec3 kept = p.x1[2];
  p.x1[2].setZero();
  EXPECT_TRUE(EssentialFromFivePoints(p.x1, p.x2).empty());
  p.x1[2] = kept;
  p.x2[3].x() = std::nan("");
  EXPECT_TRUE(EssentialFromFivePoints(p.x1, p.x2).empty());
}

TEST(PosesFromEssential, HoldsTheTrueMotion) {
  Random random(10);
  for (int trial = 0; trial < 500; ++trial) {
    const Problem p = MakeProblem(Setup::kGeneral, random);
    // Neither the scale nor the sign of E means anything.
    const auto poses = PosesFromEssential(-3.5 * EssentialFromPose(p.truth));
    int found = 0;
    for (const RigidTransform& pose : poses) {
      EXPECT_LT(RotationDefect(pose.rotation), 1e-12);
      EXPECT_NEAR(pose.translation.norm(), 1, 1e-14);
      EXPECT_LT(Distance(EssentialFromPose(pose), EssentialFromPose(p.truth)),
                1e-12);
      found += RotationAngleBetween(pose.rotation, p.truth.rotation) < 1e-7 &&
               AngleBetween(pose.translation, p.truth.translation) < 1e-7;
    }
    EXPECT_EQ(found, 1);
  }
}

}  // namespace
}  // namespace lowlap
