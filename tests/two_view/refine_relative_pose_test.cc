#include "lowlap/two_view/refine_relative_pose.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <numeric>

#include "lowlap/geometry/epipolar.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::DirectionErrorDeg;
using testing::MakeTwoViewScene;
using testing::RotationErrorDeg;
using testing::TwoViewSceneOptions;

std::vector<int> All(const PointPairs& pairs) {
  std::vector<int> all(pairs.size());
  std::iota(all.begin(), all.end(), 0);
  return all;
}

RigidTransform Moved(const RigidTransform& pose, const Vec5& step) {
  const Vec3 w = step.head<3>();
  const Vec2 d = step.tail<2>();
  return {RotationFromAngleAxis(w) * pose.rotation,
          (pose.translation + TangentBasis(pose.translation) * d).normalized()};
}

TEST(SampsonResidual, HasTheValueOfTheSampsonDistance) {
  TwoViewSceneOptions options;
  options.noise_px = 3;
  const auto scene = MakeTwoViewScene(options, 1);
  const PointPairs pairs = scene.Pairs();
  const SampsonResidual residual(scene.cam2_from_cam1, testing::kFocalPx,
                                 testing::kFocalPx);
  for (int i = 0; i < pairs.size(); ++i) {
    const double expected =
        testing::kFocalPx *
        std::sqrt(SampsonSquared(EssentialFromPose(scene.cam2_from_cam1),
                                 pairs.x1[i], pairs.x2[i]));
    EXPECT_NEAR(std::abs(residual(pairs.x1[i], pairs.x2[i])), expected, 1e-9);
  }
}

TEST(SampsonResidual, HasTheDerivativeOfFiniteDifferences) {
  TwoViewSceneOptions options;
  options.noise_px = 5;
  options.num_right = 50;
  const auto scene = MakeTwoViewScene(options, 2);
  const RigidTransform& pose = scene.cam2_from_cam1;
  const SampsonResidual residual(pose, 900, 1700);
  for (int i = 0; i < 50; ++i) {
    const Vec3& x1 = scene.features1.points[i];
    const Vec3& x2 = scene.features2.points[i];
    Vec5 jacobian;
    residual(x1, x2, &jacobian);
    for (int k = 0; k < 5; ++k) {
      const double h = 1e-6;
      const auto at = [&](double step) {
        return SampsonResidual(Moved(pose, step * Vec5::Unit(k)), 900, 1700)(
            x1, x2);
      };
      EXPECT_NEAR(jacobian[k], (at(h) - at(-h)) / (2 * h),
                  1e-5 * (1 + std::abs(jacobian[k])));
    }
  }
}

TEST(SampsonResidual, IsZeroAtBothEpipoles) {
  const RigidTransform forward{Mat3::Identity(), Vec3::UnitZ()};
  const SampsonResidual residual(forward, 1000, 1000);
  Vec5 jacobian = Vec5::Ones();
  EXPECT_EQ(residual(Vec3::UnitZ(), Vec3::UnitZ(), &jacobian), 0);
  EXPECT_EQ(jacobian, Vec5::Zero());
}

TEST(RefineRelativePose, ConvergesToTheTruthWithoutNoise) {
  const auto scene = MakeTwoViewScene({}, 3);
  const PointPairs pairs = scene.Pairs();
  Vec5 offset;
  offset << 0.02, -0.03, 0.01, 0.05, -0.04;
  const RigidTransform refined = RefineRelativePose(
      Moved(scene.cam2_from_cam1, offset), pairs, All(pairs), {5.0, 50});
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
  const RigidTransform refined =
      RefineRelativePose(scene.cam2_from_cam1, pairs, All(pairs), {0.7, 50});
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
  EXPECT_FALSE(RelativePoseCovariance(start, scene.Pairs(), {0, 1, 2, 3}, 1));
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
    const RigidTransform refined =
        RefineRelativePose(scene.cam2_from_cam1, pairs, All(pairs), {1.0, 50});
    const auto covariance =
        RelativePoseCovariance(refined, pairs, All(pairs), 1.0);
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
