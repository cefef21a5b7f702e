#include "lowlap/geometry/internal/closest_direction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "geometry/random_geometry.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::RandomVector;

// The sine of the angle between u and v + lambda w.
double Sine(const Vec3& u, const Vec3& v, const Vec3& w, double lambda) {
  const Vec3 x = v + lambda * w;
  return u.cross(x).norm() / (u.norm() * x.norm());
}

// The least sine over all lambda. The direction of v + lambda w turns through
// half a circle, cos(phi) v + sin(phi) w, which is searched evenly.
double LeastSine(const Vec3& u, const Vec3& v, const Vec3& w) {
  const auto sine = [&](double phi) {
    const Vec3 x = std::cos(phi) * v + std::sin(phi) * w;
    return u.cross(x).norm() / (u.norm() * x.norm());
  };
  double best_phi = 0, step = kPi / 400;
  for (int n = -200; n <= 200; ++n) {
    if (sine(n * step) < sine(best_phi)) best_phi = n * step;
  }
  for (int round = 0; round < 60; ++round) {
    step *= 0.6;
    for (const double phi : {best_phi - step, best_phi + step}) {
      if (sine(phi) < sine(best_phi)) best_phi = phi;
    }
  }
  return sine(best_phi);
}

Vec3 OfAnySize(Random& random) {
  const Vec3 direction = RandomVector(random);
  return std::exp(random.Gaussian(3)) * direction;
}

TEST(ClosestDirection, AgreesWithSearchOnRandomVectors) {
  Random random(1);
  for (int n = 0; n < 2000; ++n) {
    // Of very different lengths, as depths and baselines are.
    const Vec3 u = OfAnySize(random);
    const Vec3 v = OfAnySize(random);
    const Vec3 w = OfAnySize(random);
    const auto lambda = ClosestDirection(u, v, w);
    ASSERT_TRUE(lambda);
    EXPECT_NEAR(Sine(u, v, w, *lambda), LeastSine(u, v, w), 1e-7);
  }
}

TEST(ClosestDirection, IsExactWhenTheDirectionIsReached) {
  Random random(2);
  for (int n = 0; n < 500; ++n) {
    const Vec3 v = RandomVector(random), w = RandomVector(random);
    const double truth = std::exp(random.Gaussian());
    const Vec3 u = random.Uniform(0.1, 4) * (v + truth * w);
    const auto lambda = ClosestDirection(u, v, w);
    ASSERT_TRUE(lambda);
    EXPECT_NEAR(*lambda, truth, 1e-8 * (1 + truth));
  }
}

TEST(ClosestDirection, IsInvariant) {
  Random random(3);
  for (int n = 0; n < 100; ++n) {
    const Vec3 u = RandomVector(random), v = RandomVector(random),
               w = RandomVector(random);
    const double lambda = *ClosestDirection(u, v, w);
    const double tolerance = 1e-9 * (1 + std::abs(lambda));
    EXPECT_NEAR(*ClosestDirection(-5 * u, v, w), lambda, tolerance);
    EXPECT_NEAR(*ClosestDirection(u, v, 2 * w), lambda / 2, tolerance);
    EXPECT_NEAR(*ClosestDirection(u, 3 * v, w), lambda * 3, 3 * tolerance);
    const Mat3 rotation = testing::RandomRotation(random);
    EXPECT_NEAR(*ClosestDirection(rotation * u, rotation * v, rotation * w),
                lambda, 1e-6 * (1 + std::abs(lambda)));
    // Swapped ends: the ratio inverts.
    EXPECT_NEAR(*ClosestDirection(u, w, v), 1 / lambda,
                1e-7 * (1 + 1 / std::abs(lambda)));
  }
}

// The other stationary point of the sine is never the minimum.
TEST(ClosestDirection, TheOtherRootIsTheMaximum) {
  Random random(4);
  for (int n = 0; n < 200; ++n) {
    const Vec3 u = RandomVector(random), v = RandomVector(random),
               w = RandomVector(random);
    const double other = -u.dot(v) / u.dot(w);
    EXPECT_NEAR(Sine(u, v, w, other), 1, 1e-9);
  }
}

TEST(ClosestDirection, DegenerateCases) {
  const Vec3 u(1, 2, 3), v(0.5, -1, 2);
  EXPECT_FALSE(ClosestDirection(u, v, 2 * v));  // v along w
  const Vec3 across = 1e-10 * v.norm() * v.unitOrthogonal();
  EXPECT_FALSE(ClosestDirection(u, v, v + across));     // almost
  EXPECT_FALSE(ClosestDirection(u, v, Vec3::Zero()));   // no baseline
  EXPECT_FALSE(ClosestDirection(u, Vec3::Zero(), v));   // no point
  EXPECT_FALSE(ClosestDirection(Vec3::Zero(), v, u));   // no direction
  EXPECT_FALSE(ClosestDirection(v, Vec3(3, 1, 1), v));  // only at infinity
  // u orthogonal to the plane of v and w: every lambda is as bad.
  EXPECT_FALSE(ClosestDirection(Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, 1, 0)));
}

TEST(ClosestDirection, ZeroIsAnAnswer) {
  const auto lambda =
      ClosestDirection(Vec3(2, 0, 0), Vec3(1, 0, 0), Vec3(0, 1, 0));
  ASSERT_TRUE(lambda);
  EXPECT_NEAR(*lambda, 0, 1e-15);
}

}  // namespace
}  // namespace lowlap
