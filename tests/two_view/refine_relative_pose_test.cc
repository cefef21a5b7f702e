#include "lowlap/two_view/internal/search/refine_relative_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>

#include "lowlap/geometry/internal/epipolar.h"
#include "tests/support/random_vectors.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::AllIndices;
using testing::DirectionErrorDeg;
using testing::MakeTwoViewScene;
using testing::RotationErrorDeg;
using testing::TwoViewSceneOptions;

// One pair of arbitrary rays, with or without shapes of their errors.
PointPairs OnePair(Random& random, bool round) {
  PointPairs pairs;
  pairs.focal1_px = 900;
  pairs.focal2_px = 1700;
  pairs.x1 = {testing::UniformVec2(random, {-1, -1}, {1, 1}).homogeneous()};
  pairs.x2 = {testing::UniformVec2(random, {-1, -1}, {1, 1}).homogeneous()};
  if (!round) {
    Mat2 covariance;
    covariance << 3, 1.5, 1.5, 1;
    pairs.covariance1 = {covariance};
    pairs.covariance2 = {Mat2(covariance.inverse())};
  }
  return pairs;
}

TEST(SampsonResidual, HasTheValueOfTheSampsonDistance) {
  const auto scene = MakeTwoViewScene({}, 1);
  Random random(1);
  const PointPairs pairs = OnePair(random, true);
  const Mat3 e = EssentialFromPose(scene.cam2_from_cam1);
  const Vec3 line2 = e * pairs.x1[0], line1 = e.transpose() * pairs.x2[0];
  const double expected =
      pairs.x2[0].dot(line2) /
      std::hypot(line2.head<2>().norm() / 1700, line1.head<2>().norm() / 900);
  EXPECT_NEAR(SampsonResidual(scene.cam2_from_cam1, pairs)(0), expected,
              1e-12 * std::abs(expected));
}

TEST(SampsonResidual, IsLessWhereThePointIsUncertainAcrossTheEpipolarLine) {
  // Motion along x: epipolar lines are horizontal.
  const RigidTransform sideways{Mat3::Identity(), Vec3::UnitX()};
  PointPairs pairs;
  pairs.focal1_px = pairs.focal2_px = 1000;
  pairs.x1 = {Vec3(0, 0, 1)};
  pairs.x2 = {Vec3(0.2, 0.002, 1)};
  const double round = SampsonResidual(sideways, pairs)(0);
  EXPECT_NEAR(std::abs(round), 2 / std::sqrt(2.0), 1e-9);
  pairs.covariance1 = pairs.covariance2 = {Vec2(1, 16).asDiagonal()};
  EXPECT_NEAR(SampsonResidual(sideways, pairs)(0), round / 4, 1e-9);
  pairs.covariance1 = pairs.covariance2 = {Vec2(16, 1).asDiagonal()};
  EXPECT_NEAR(SampsonResidual(sideways, pairs)(0), round, 1e-9);
}

TEST(SampsonResidual, HasTheDerivativeOfFiniteDifferences) {
  Random random(2);
  for (int trial = 0; trial < 20; ++trial) {
    const RigidTransform pose =
        MakeTwoViewScene({}, 100 + trial).cam2_from_cam1;
    const PointPairs pairs = OnePair(random, trial % 2 == 0);
    Vec5 jacobian;
    SampsonResidual(pose, pairs)(0, &jacobian);
    for (int k = 0; k < 5; ++k) {
      const double h = 1e-6;
      const auto at = [&](double step) {
        return SampsonResidual(MovedPose(pose, step * Vec5::Unit(k)), pairs)(0);
      };
      EXPECT_NEAR(jacobian[k], (at(h) - at(-h)) / (2 * h),
                  1e-5 * (1 + std::abs(jacobian[k])));
    }
  }
}

TEST(SampsonResidual, IsZeroAtBothEpipoles) {
  const RigidTransform forward{Mat3::Identity(), Vec3::UnitZ()};
  PointPairs pairs;
  pairs.x1 = pairs.x2 = {Vec3::UnitZ()};
  Vec5 jacobian = Vec5::Ones();
  EXPECT_EQ(SampsonResidual(forward, pairs)(0, &jacobian), 0);
  EXPECT_EQ(jacobian, Vec5::Zero());
}

TEST(RefineRelativePose, ConvergesToTheTruthWithoutNoise) {
  const auto scene = MakeTwoViewScene({}, 3);
  const PointPairs pairs = scene.Pairs();
  Vec5 offset;
  offset << 0.02, -0.03, 0.01, 0.05, -0.04;
  const RigidTransform refined =
      RefineRelativePose(MovedPose(scene.cam2_from_cam1, offset), pairs,
                         AllIndices(pairs), {5.0, 50, {}, 0});
  EXPECT_LT(RotationErrorDeg(refined.rotation, scene.cam2_from_cam1.rotation),
            1e-7);
  EXPECT_LT(
      DirectionErrorDeg(refined.translation, scene.cam2_from_cam1.translation),
      1e-7);
}

TEST(RefineRelativePose, IsHardlyMovedByOutliers) {
  TwoViewSceneOptions options;
  options.noise_px = 0.3;
  options.num_wrong = 40;
  const auto scene = MakeTwoViewScene(options, 4);
  const PointPairs pairs = scene.Pairs();
  const RigidTransform refined = RefineRelativePose(
      scene.cam2_from_cam1, pairs, AllIndices(pairs), {0.7, 50, {}, 0});
  EXPECT_LT(RotationErrorDeg(refined.rotation, scene.cam2_from_cam1.rotation),
            0.1);
}

TEST(RefineRelativePose, ReturnsTheStartForTooFewMatches) {
  const auto scene = MakeTwoViewScene({}, 5);
  const RigidTransform start{Mat3::Identity(), Vec3::UnitX()};
  const RigidTransform refined =
      RefineRelativePose(start, scene.Pairs(), {0, 1, 2, 3}, {});
  EXPECT_EQ(refined.rotation, start.rotation);
  EXPECT_EQ(refined.translation, start.translation);
  EXPECT_FALSE(RelativePoseCovariance(start, scene.Pairs(), {0, 1, 2, 3}, {}));
}

TEST(RelativePoseCovariance, IsTheScatterOfRepeatedEstimates) {
  constexpr int kNumTrials = 400;
  TwoViewSceneOptions options;
  options.noise_px = 0.5;
  options.num_right = 150;
  double sum = 0;
  for (int trial = 0; trial < kNumTrials; ++trial) {
    const auto scene = MakeTwoViewScene(options, 1000 + trial);
    const PointPairs pairs = scene.Pairs();
    const RigidTransform refined = RefineRelativePose(
        scene.cam2_from_cam1, pairs, AllIndices(pairs), {1.0, 50, {}, 0});
    const auto covariance = RelativePoseCovariance(
        refined, pairs, AllIndices(pairs), {1.0, 50, {}, 0});
    ASSERT_TRUE(covariance);
    // The error that leads from the estimate to the truth, in its own chart.
    Vec5 error;
    error << AngleAxisFromRotation(scene.cam2_from_cam1.rotation *
                                   refined.rotation.transpose()),
        TangentBasis(refined.translation).transpose() *
            scene.cam2_from_cam1.translation;
    sum += error.dot(covariance->ldlt().solve(error));
  }
  // Chi squared with 5 degrees of freedom: the mean of 400 is 5 +- 0.16.
  EXPECT_NEAR(sum / kNumTrials, 5, 0.6);
}

}  // namespace
}  // namespace lowlap
