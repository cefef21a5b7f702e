#include "lowlap/geometry/plucker_line.h"

#include <gtest/gtest.h>

#include <limits>

#include "geometry/random_geometry.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::RandomTransform;
using testing::RandomVector;
using testing::VectorNear;

PluckerLine RandomLine(Random& random) {
  const Vec3 second = RandomVector(random);
  return PluckerLine::FromPoints(RandomVector(random), second);
}

Vec3 PointAt(const PluckerLine& line, double s) {
  return line.FootPoint() + s * line.direction;
}

// The least value of f over the reals, by shrinking a grid round its best node.
template <class Function>
double MinimumOverLine(const Function& f, double* at = nullptr) {
  double centre = 0, step = 10, best = f(0.0);
  for (int round = 0; round < 60; ++round) {
    double next = centre;
    for (int k = -20; k <= 20; ++k) {
      const double value = f(centre + k * step);
      if (value < best) {
        best = value;
        next = centre + k * step;
      }
    }
    centre = next;
    step *= 0.6;
  }
  if (at) *at = centre;
  return best;
}

TEST(PluckerLine, HoldsItsPoints) {
  Random random(1);
  for (int n = 0; n < 100; ++n) {
    const Vec3 a = RandomVector(random), b = RandomVector(random);
    const PluckerLine line = PluckerLine::FromPoints(a, b);
    EXPECT_NEAR(line.direction.norm(), 1, 1e-14);
    EXPECT_NEAR(line.direction.dot(line.moment), 0, 1e-13);
    for (const double s : {-2.0, 0.0, 0.3, 1.0}) {
      const Vec3 x = a + s * (b - a);
      EXPECT_THAT(Vec3(x.cross(line.direction)),
                  VectorNear(line.moment, 1e-12));
      EXPECT_THAT(line.ClosestPointTo(x), VectorNear(x, 1e-12));
    }
  }
}

TEST(PluckerLine, FootPointIsClosestToTheOrigin) {
  Random random(2);
  for (int n = 0; n < 100; ++n) {
    const PluckerLine line = RandomLine(random);
    EXPECT_NEAR(line.FootPoint().norm(), line.moment.norm(), 1e-13);
    EXPECT_NEAR(line.FootPoint().dot(line.direction), 0, 1e-13);
  }
  const PluckerLine through_origin =
      PluckerLine::FromPointAndDirection(Vec3::Zero(), Vec3(0, 3, 0));
  EXPECT_EQ(through_origin.FootPoint(), Vec3(0, 0, 0));
}

TEST(PluckerLine, ClosestPointToAPointAgreesWithSearch) {
  Random random(3);
  for (int n = 0; n < 50; ++n) {
    const PluckerLine line = RandomLine(random);
    const Vec3 p = 3 * RandomVector(random);
    const double least = MinimumOverLine(
        [&](double s) { return (PointAt(line, s) - p).norm(); });
    EXPECT_NEAR((line.ClosestPointTo(p) - p).norm(), least, 1e-9);
  }
}

TEST(PluckerLine, TransformsAsItsPoints) {
  Random random(4);
  for (int n = 0; n < 100; ++n) {
    const RigidTransform b_from_a = RandomTransform(random);
    const Vec3 p = RandomVector(random), q = RandomVector(random);
    const PluckerLine moved = b_from_a * PluckerLine::FromPoints(p, q);
    const PluckerLine expected =
        PluckerLine::FromPoints(b_from_a * p, b_from_a * q);
    EXPECT_THAT(moved.direction, VectorNear(expected.direction, 1e-12));
    EXPECT_THAT(moved.moment, VectorNear(expected.moment, 1e-12));
  }
}

TEST(LineFromTwoViews, RecoversTheLine) {
  Random random(5);
  for (int n = 0; n < 200; ++n) {
    const RigidTransform cam2_from_cam1 = RandomTransform(random);
    const PluckerLine truth = RandomLine(random);
    // Normals of any length and sign.
    const Vec3 l1 = random.Uniform(-2, 2) * truth.moment;
    const Vec3 l2 = random.Uniform(-2, 2) * (cam2_from_cam1 * truth).moment;
    const auto line = LineFromTwoViews(cam2_from_cam1, l1, l2);
    ASSERT_TRUE(line);
    const double sign = line->direction.dot(truth.direction) > 0 ? 1 : -1;
    EXPECT_THAT(Vec3(sign * line->direction),
                VectorNear(truth.direction, 1e-7));
    EXPECT_THAT(Vec3(sign * line->moment), VectorNear(truth.moment, 1e-7));
  }
}

TEST(LineFromTwoViews, LineInAnEpipolarPlaneIsRefused) {
  // The baseline is along x, so the plane y = 0 is epipolar.
  const RigidTransform cam2_from_cam1{Mat3::Identity(), Vec3(-1, 0, 0)};
  const PluckerLine line =
      PluckerLine::FromPoints(Vec3(0, 0, 4), Vec3(2, 0, 5));
  EXPECT_FALSE(LineFromTwoViews(cam2_from_cam1, line.moment,
                                (cam2_from_cam1 * line).moment));
  EXPECT_FALSE(LineFromTwoViews(cam2_from_cam1, Vec3::Zero(), Vec3::UnitX()));
  EXPECT_FALSE(LineFromTwoViews(cam2_from_cam1, Vec3(0, 1, 1), Vec3(0, 1, 1.05),
                                /*min_sine=*/0.1));
}

TEST(ClosestPointOnLine, AgreesWithSearch) {
  Random random(7);
  for (int n = 0; n < 50; ++n) {
    const PluckerLine a = RandomLine(random), b = RandomLine(random);
    if (a.direction.cross(b.direction).norm() < 0.3) continue;
    const auto distance_to_b = [&](double s) {
      const Vec3 x = PointAt(a, s);
      return (b.ClosestPointTo(x) - x).norm();
    };
    double at = 0;
    const double least = MinimumOverLine(distance_to_b, &at);
    const auto point = ClosestPointOnLine(a, b);
    ASSERT_TRUE(point);
    EXPECT_THAT(*point, VectorNear(PointAt(a, at), 1e-5));
    EXPECT_NEAR((b.ClosestPointTo(*point) - *point).norm(), least, 1e-9);
    EXPECT_NEAR(LineDistance(a, b), least, 1e-9);
    EXPECT_NEAR(LineDistance(b, a), least, 1e-9);
  }
}

TEST(ClosestPointOnLine, ParallelLinesHaveNone) {
  const PluckerLine a =
      PluckerLine::FromPointAndDirection(Vec3(0, 0, 5), Vec3(1, 1, 0));
  const PluckerLine b =
      PluckerLine::FromPointAndDirection(Vec3(0, 0, 8), Vec3(-2, -2, 0));
  EXPECT_FALSE(ClosestPointOnLine(a, b));
  EXPECT_NEAR(LineDistance(a, b), 3, 1e-12);
  EXPECT_NEAR(LineDistance(a, a), 0, 1e-12);
}

TEST(LineDistance, IsContinuousNearParallel) {
  const PluckerLine a =
      PluckerLine::FromPointAndDirection(Vec3(0, 0, 5), Vec3(1, 0, 0));
  for (const double tilt : {1e-3, 1e-6, 1e-8, 1e-10, 0.0}) {
    // Tilted within the plane y-x about a point opposite a's foot.
    const PluckerLine b =
        PluckerLine::FromPointAndDirection(Vec3(0, 0, 8), Vec3(1, tilt, 0));
    EXPECT_NEAR(LineDistance(a, b), 3, 1e-6) << tilt;
  }
}

TEST(ClosestPointToRay, AgreesWithSearch) {
  Random random(8);
  for (int n = 0; n < 50; ++n) {
    const PluckerLine line = RandomLine(random);
    Vec3 bearing = RandomVector(random);
    bearing *= random.Uniform(0.1, 5);
    if (line.direction.cross(bearing.normalized()).norm() < 0.3) continue;
    double at = 0;
    MinimumOverLine(
        [&](double s) {
          return PointAt(line, s).cross(bearing.normalized()).norm();
        },
        &at);
    const auto point = ClosestPointToRay(line, bearing);
    ASSERT_TRUE(point);
    EXPECT_THAT(*point, VectorNear(PointAt(line, at), 1e-5));
  }
  const PluckerLine line = RandomLine(random);
  EXPECT_FALSE(ClosestPointToRay(line, 3 * line.direction));
}

}  // namespace
}  // namespace lowlap
