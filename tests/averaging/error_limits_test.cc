#include "lowlap/averaging/internal/error_limits.h"

#include <gtest/gtest.h>

namespace lowlap {
namespace {

TEST(ErrorLimits, AreDeviationsOrTheLeastThatIsFalse) {
  PoseOptions options;
  options.outlier_reach = 4;
  options.least_false_deg = 2;
  const ErrorLimits limits = LimitsOf(options);
  EXPECT_DOUBLE_EQ(limits.RotationRad(0.1, 0.2), 0.8);
  EXPECT_DOUBLE_EQ(limits.RotationRad(0.3, 0.2), 1.2);
  EXPECT_DOUBLE_EQ(limits.RotationRad(1e-4, 1e-3), RadFromDeg(2));
  EXPECT_DOUBLE_EQ(limits.DirectionRad(0.1, 0.2), 0.8);
  EXPECT_DOUBLE_EQ(limits.DirectionRad(1e-4, 1e-3), RadFromDeg(6));
}

TEST(ResidualStddev, IsRobustAndNeverBelowTheFloor) {
  const double of_rotations = ResidualStddev<3>({0.01, 0.02, 3, 0.015, 0.03});
  EXPECT_DOUBLE_EQ(of_rotations, 0.02 / kMedianOfNorm<3>);
  EXPECT_DOUBLE_EQ(ResidualStddev<2>({1e-6, 1e-6, 1}), kPoseErrorFloorRad);
  EXPECT_DOUBLE_EQ(ResidualStddev<2>({}), kPoseErrorFloorRad);
}

}  // namespace
}  // namespace lowlap
