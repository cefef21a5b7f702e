#include "lowlap/two_view/internal/relative_pose_estimator.h"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>

#include "tests/support/matchers.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::DirectionErrorDeg;
using testing::IsOk;
using testing::MakeTwoViewScene;
using testing::RotationErrorDeg;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

TwoViewResult Estimate(const TwoViewScene& scene, std::uint64_t seed = 1) {
  auto result = EstimateRelativePose(scene.Input(), {}, seed);
  EXPECT_THAT(result, IsOk());
  return result ? *result : TwoViewResult{};
}

void ExpectPose(const RelativePose& pose, const TwoViewScene& scene,
                double max_rotation_deg, double max_direction_deg) {
  EXPECT_LT(RotationErrorDeg(pose.rotation, scene.cam2_from_cam1.rotation),
            max_rotation_deg);
  EXPECT_LT(DirectionErrorDeg(pose.direction, scene.cam2_from_cam1.translation),
            max_direction_deg);
}

int NumRight(const RelativePose& pose, const TwoViewScene& scene) {
  return static_cast<int>(std::count_if(
      pose.point_inliers.begin(), pose.point_inliers.end(),
      [&](const FeatureMatch& m) {
        return m.first < static_cast<FeatureIndex>(scene.num_right);
      }));
}

// The same photographs with more pixels, and errors of more pixels.
TEST(EstimateRelativePose, LargeImagesMayErrByMorePixels) {
  TwoViewSceneOptions options;
  options.num_right = 60;
  options.num_wrong = 60;
  options.noise_px = 0.7;
  const TwoViewScene scene = MakeTwoViewScene(options, 3);
  const auto estimate = [&](double factor) {
    TwoViewScene larger = scene;
    larger.features1.focal_px *= factor;
    larger.features2.focal_px *= factor;
    TwoViewInput input = larger.Input();
    input.image_size1_px *= factor;
    input.image_size2_px *= factor;
    const auto result = EstimateRelativePose(input, {}, 5);
    EXPECT_THAT(result, IsOk());
    return result->pose;
  };
  const RelativePose medium = estimate(2), large = estimate(8);
  EXPECT_LT(RotationErrorDeg(large.rotation, medium.rotation), 1e-4);
  EXPECT_LT(DirectionErrorDeg(large.direction, medium.direction), 1e-3);
  EXPECT_EQ(large.point_inliers, medium.point_inliers);
  EXPECT_NEAR(large.point_threshold_px / medium.point_threshold_px, 4, 1e-9);
  EXPECT_GT(large.point_inliers.size(), 50u);
}

TEST(EstimateRelativePose, IsExactWithoutNoise) {
  for (int seed = 0; seed < 5; ++seed) {
    const TwoViewScene scene = MakeTwoViewScene({}, seed);
    const TwoViewResult result = Estimate(scene, seed);
    ExpectPose(result.pose, scene, 1e-6, 1e-6);
    EXPECT_EQ(result.geometry, TwoViewGeometry::kGeneral);
    EXPECT_EQ(result.pose.point_inliers, scene.matches);
    EXPECT_EQ(result.pose.views, (ViewPair{3, 8}));
    EXPECT_LT(result.pose.log10_nfa, -300);
  }
}

TEST(EstimateRelativePose, ErrorsGrowWithTheNoise) {
  double last = 0;
  for (const double noise_px : {0.1, 0.4, 1.2}) {
    double sum = 0;
    for (int seed = 0; seed < 6; ++seed) {
      TwoViewSceneOptions options;
      options.noise_px = noise_px;
      options.num_right = 300;
      const TwoViewScene scene = MakeTwoViewScene(options, seed);
      const TwoViewResult result = Estimate(scene);
      const double error =
          RotationErrorDeg(result.pose.rotation, scene.cam2_from_cam1.rotation);
      EXPECT_LT(error, 0.3 * noise_px);
      sum += error;
      // The threshold finds the noise, and most inliers within it.
      EXPECT_GT(result.pose.point_threshold_px, noise_px);
      EXPECT_LT(result.pose.point_threshold_px, 5 * noise_px);
      EXPECT_GT(result.pose.point_inliers.size(), 270u);
    }
    EXPECT_GT(sum, last);
    last = sum;
  }
}

TEST(EstimateRelativePose, StandsSeventyPercentOutliers) {
  for (int seed = 0; seed < 4; ++seed) {
    TwoViewSceneOptions options;
    options.num_right = 150;
    options.num_wrong = 350;
    options.noise_px = 0.5;
    const TwoViewScene scene = MakeTwoViewScene(options, 10 + seed);
    const TwoViewResult result = Estimate(scene, seed);
    ExpectPose(result.pose, scene, 0.3, 1.0);
    const int right = NumRight(result.pose, scene);
    EXPECT_GT(right, 130);
    EXPECT_LT(static_cast<int>(result.pose.point_inliers.size()) - right, 12);
  }
}

TEST(EstimateRelativePose, IsNotBentByMatchesBesideTheirEpipolarLines) {
  // A window taken for its neighbour in the row: off along a line that is
  // almost, but not quite, the epipolar line.
  TwoViewSceneOptions options;
  options.num_right = 300;
  options.noise_px = 0.3;
  TwoViewScene scene = MakeTwoViewScene(options, 20);
  Random random(21);
  for (int n = 0; n < 180; ++n) {
    const Vec3 x1 = scene.features1.points[n];
    const Vec3 x2 = scene.features2.points[n] +
                    Vec3(60, 9, 0) * (random.Uniform(0.8, 1.2) / 1300);
    const auto index = static_cast<FeatureIndex>(scene.features1.points.size());
    scene.features1.points.push_back(x1);
    scene.features2.points.push_back(x2);
    scene.matches.push_back({index, index});
  }
  ExpectPose(Estimate(scene).pose, scene, 0.08, 0.3);
}

TEST(EstimateRelativePose, GivesTheInverseWhenTheViewsAreSwapped) {
  TwoViewSceneOptions options;
  options.num_right = 200;
  options.num_wrong = 100;
  options.noise_px = 0.4;
  const TwoViewScene scene = MakeTwoViewScene(options, 30);
  const RelativePose forward = Estimate(scene).pose;
  TwoViewInput input = scene.Input();
  std::swap(input.features1, input.features2);
  const auto swapped = EstimateRelativePose(input, {}, 1);
  ASSERT_THAT(swapped, IsOk());
  const RigidTransform back = swapped->pose.Cam2FromCam1().Inverse();
  // Different draws and thresholds: equal to a fraction of the error.
  EXPECT_LT(RotationErrorDeg(back.rotation, forward.rotation), 0.05);
  EXPECT_LT(DirectionErrorDeg(back.translation, forward.direction), 0.1);
}

TEST(EstimateRelativePose, IsDeterministicAndHardlyDependsOnTheSeed) {
  TwoViewSceneOptions options;
  options.num_wrong = 200;
  options.noise_px = 0.5;
  const TwoViewScene scene = MakeTwoViewScene(options, 40);
  const RelativePose first = Estimate(scene, 5).pose;
  EXPECT_TRUE(first == Estimate(scene, 5).pose);
  const RelativePose other = Estimate(scene, 6).pose;
  EXPECT_LT(RotationErrorDeg(first.rotation, other.rotation), 0.05);
}

// The search draws other samples; what it ends at is the same.
TEST(EstimateRelativePose, OfFewHundredMatchesIsTheSameForEverySeed) {
  TwoViewSceneOptions options;
  options.num_right = 120;
  options.num_wrong = 100;
  options.noise_px = 0.5;
  for (int scene_seed = 50; scene_seed < 53; ++scene_seed) {
    const TwoViewScene scene = MakeTwoViewScene(options, scene_seed);
    const RelativePose first = Estimate(scene, 1).pose;
    for (int seed = 2; seed < 5; ++seed) {
      const RelativePose other = Estimate(scene, seed).pose;
      EXPECT_LT(RotationErrorDeg(first.rotation, other.rotation), 1e-4);
      EXPECT_LT(DirectionErrorDeg(first.direction, other.direction), 1e-4);
      EXPECT_NEAR(first.log10_nfa, other.log10_nfa, 1e-6);
      EXPECT_EQ(first.point_inliers, other.point_inliers);
    }
  }
}

TEST(EstimateRelativePose, HandlesForwardMotionAndTurningAround) {
  for (const RigidTransform& motion :
       {RigidTransform{Mat3::Identity(), -Vec3::UnitZ()},
        RigidTransform{RotationFromAngleAxis(Vec3(0, 0, 2.8)),
                       Vec3(0.3, 0.1, -1).normalized()},
        RigidTransform{RotationFromAngleAxis(Vec3(0, 0.9, 0)),
                       Vec3(-1, 0, 0.6).normalized()}}) {
    TwoViewSceneOptions options;
    options.cam2_from_cam1 = motion;
    options.num_wrong = 60;
    options.noise_px = 0.3;
    options.baseline = motion.rotation.isIdentity() ? 1 : 4;
    const TwoViewScene scene = MakeTwoViewScene(options, 50);
    const TwoViewResult result = Estimate(scene);
    ExpectPose(result.pose, scene, 0.2, 0.6);
    EXPECT_TRUE(result.HasDirection());
  }
}

TEST(EstimateRelativePose, AcceptsDifferentFocalLengths) {
  TwoViewSceneOptions options;
  options.noise_px = 0.5;
  TwoViewScene scene = MakeTwoViewScene(options, 60);
  scene.features2.focal_px *= 2;  // camera 2 with twice the resolution
  TwoViewInput input = scene.Input();
  input.image_size2_px *= 2;
  const auto result = EstimateRelativePose(input, {}, 1);
  ASSERT_THAT(result, IsOk());
  ExpectPose(result->pose, scene, 0.2, 0.8);
}

TEST(EstimateRelativePose, DropsMatchesThatWouldLieBehindACamera) {
  TwoViewSceneOptions options;
  options.num_right = 150;
  options.noise_px = 0.3;
  TwoViewScene scene = MakeTwoViewScene(options, 70);
  // On the epipolar line, on the wrong side of infinity.
  for (int n = 0; n < 20; ++n) {
    const Vec3 x1 = scene.features1.points[n];
    const Vec3 y = scene.cam2_from_cam1.rotation * (5 * x1) -
                   0.8 * scene.cam2_from_cam1.translation;
    const auto index = static_cast<FeatureIndex>(scene.features1.points.size());
    scene.features1.points.push_back(x1);
    scene.features2.points.push_back(y / y.z());
    scene.matches.push_back({index, index});
  }
  const TwoViewResult result = Estimate(scene);
  ExpectPose(result.pose, scene, 0.2, 0.8);
  EXPECT_EQ(NumRight(result.pose, scene),
            static_cast<int>(result.pose.point_inliers.size()));
}

TEST(EstimateRelativePose, StatesACovarianceThatFitsItsErrors) {
  constexpr int kNumTrials = 60;
  TwoViewSceneOptions options;
  options.noise_px = 0.5;
  options.num_right = 150;
  options.num_wrong = 30;
  double sum = 0;
  for (int trial = 0; trial < kNumTrials; ++trial) {
    const TwoViewScene scene = MakeTwoViewScene(options, 2000 + trial);
    const RelativePose pose = Estimate(scene, trial).pose;
    ASSERT_TRUE(pose.covariance);
    Eigen::Matrix<double, 5, 1> error;
    error << AngleAxisFromRotation(scene.cam2_from_cam1.rotation *
                                   pose.rotation.transpose()),
        TangentBasis(pose.direction).transpose() *
            scene.cam2_from_cam1.translation;
    sum += error.dot(pose.covariance->ldlt().solve(error));
  }
  EXPECT_GT(sum / kNumTrials, 3.5);
  EXPECT_LT(sum / kNumTrials, 7.5);
}

}  // namespace
}  // namespace lowlap
