#include "lowlap/adjustment/internal/planes/plane_fit.h"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

#include "tests/adjustment/planes_fixture.h"

namespace lowlap {
namespace {

constexpr double kThickness = 0.03;

// The bend of 200 points that are `height` over a floor.
Mat3 BendOf(const std::function<double(double, double)>& height) {
  PlaneLandmarks floor(4);
  for (int n = 0; n < 200; ++n) {
    const double x = floor.Uniform(), y = floor.Uniform();
    floor.AddPoint({x, y, height(x, y)});
  }
  std::vector<PlaneMember> members;
  for (const FreeLandmark& landmark : floor.landmarks()) {
    members.push_back({&landmark, 0.001});
  }
  return FitBend(members, {}, Vec3::Zero(), kThickness);
}

double HeightAt(const Mat3& bend, double x, double y) {
  const Vec3 arm(x, y, 0);
  return arm.dot(bend * arm);
}

TEST(FitBend, IsThatOfABowedWall) {
  const Mat3 bend =
      BendOf([](double x, double y) { return 0.01 * (x * x - x * y); });
  EXPECT_NEAR(HeightAt(bend, 2, 0), 0.04, 0.002);
  EXPECT_NEAR(HeightAt(bend, 0, 2), 0, 0.002);
  EXPECT_NEAR(HeightAt(bend, 2, 2), 0, 0.004);
  EXPECT_NEAR(HeightAt(bend, 2, -2), 0.08, 0.004);
  EXPECT_LT((bend * Vec3::UnitZ()).norm(), 1e-12);
}

// The plane is another one, but a plane.
TEST(FitBend, HasNoPartInTiltAndOffset) {
  const Mat3 bend =
      BendOf([](double x, double y) { return 0.05 + 0.02 * x - 0.01 * y; });
  EXPECT_LT(bend.norm() * 4, 0.002);
}

// Beyond what a wall's thickness allows, members must say it all the clearer.
TEST(FitBend, IsHeldToTheThickness) {
  PlaneLandmarks floor(4);
  for (int n = 0; n < 200; ++n) {
    const double x = floor.Uniform(), y = floor.Uniform();
    floor.AddPoint({x, y, 0.1 * x * x});
  }
  const auto bow_with = [&](double slack, double thickness) {
    std::vector<PlaneMember> members;
    for (const FreeLandmark& landmark : floor.landmarks()) {
      members.push_back({&landmark, slack});
    }
    return HeightAt(FitBend(members, {}, Vec3::Zero(), thickness), 2, 0);
  };
  EXPECT_NEAR(bow_with(0.1, 0.1), 0.4, 0.02);
  EXPECT_LT(bow_with(0.1, 0.002), 0.1);
}

}  // namespace
}  // namespace lowlap
