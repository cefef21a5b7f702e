#include "lowlap/two_view/internal/search/rival_spread.h"

#include <gtest/gtest.h>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

TEST(RivalWeight, FallsFromOneHalfWithTheEvidence) {
  EXPECT_DOUBLE_EQ(RivalWeight(0), 0.5);
  EXPECT_NEAR(RivalWeight(2.5), 0.1587, 1e-4);
  EXPECT_LT(RivalWeight(10), 1e-4);
}

TEST(PoseError, IsInTheFramesOfCovariances) {
  const RigidTransform pose{RotationFromAngleAxis({0.1, 0.4, -0.2}),
                            Vec3(0.3, -0.1, 2)};
  EXPECT_NEAR(PoseError(pose, pose).norm(), 0, 1e-12);
  const Vec3 turn(0.02, -0.01, 0.03);
  const Vec3 direction = pose.translation.normalized();
  const Vec2 across(0.3, -0.4);
  const Vec3 other =
      std::cos(0.5) * direction +
      std::sin(0.5) * (TangentBasis(direction) * across.normalized());
  const auto error =
      PoseError(pose, {RotationFromAngleAxis(turn) * pose.rotation, 5 * other});
  EXPECT_LT((error.head<3>() - turn).norm(), 1e-12);
  EXPECT_LT((error.tail<2>() - across).norm(), 1e-12);
}

TEST(PoseError, OfTheOppositeDirectionIsHalfATurn) {
  const RigidTransform pose{Mat3::Identity(), Vec3::UnitZ()};
  const auto error = PoseError(pose, {Mat3::Identity(), -Vec3::UnitZ()});
  EXPECT_NEAR(error.tail<2>().norm(), kPi, 1e-12);
}

TEST(SpreadOfRivals, IsTheMixtureAboutTheBest) {
  const RigidTransform best{Mat3::Identity(), Vec3::UnitZ()};
  EXPECT_TRUE(SpreadOfRivals(best, {}).isZero());
  const RigidTransform rival{RotationFromAngleAxis({0, 0.2, 0}), Vec3::UnitZ()};
  const auto spread = SpreadOfRivals(best, {{rival, 0.25}});
  EXPECT_NEAR(spread(1, 1), 0.25 * 0.04 / 1.25, 1e-12);
  EXPECT_NEAR(spread.trace(), spread(1, 1), 1e-12);
  // As many on the same side add little, since they share the weight.
  const auto many =
      SpreadOfRivals(best, std::vector<RivalPose>(8, {rival, 0.25}));
  EXPECT_NEAR(many(1, 1), 2 * 0.04 / 3, 1e-12);
}

}  // namespace
}  // namespace lowlap
