#include "lowlap/two_view/internal/planes/refine_on_plane.h"

#include <gtest/gtest.h>

#include <Eigen/LU>

#include "lowlap/two_view/internal/search/rival_spread.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::AllIndices;
using testing::DirectionErrorDeg;
using testing::kPlaneNormal;
using testing::MakeTwoViewScene;
using testing::RotationErrorDeg;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

TwoViewScene PlanarScene(double noise_px, std::uint64_t seed) {
  TwoViewSceneOptions options;
  options.planar = true;
  options.num_right = 100;
  options.noise_px = noise_px;
  return MakeTwoViewScene(options, seed);
}

TEST(RefineOnPlane, FindsTheMotionOfPointsOnAPlane) {
  Vec5 step;
  step << 0.01, -0.005, 0.01, 0.02, -0.02;
  for (int seed = 0; seed < 10; ++seed) {
    const TwoViewScene scene = PlanarScene(0, seed);
    const PointPairs pairs = scene.Pairs();
    ScenePlane plane{kPlaneNormal + Vec3(0.01, -0.01, 0.01), AllIndices(pairs)};
    const RigidTransform found =
        RefineOnPlane(MovedPose(scene.cam2_from_cam1, step), pairs,
                      AllIndices(pairs), {}, &plane);
    EXPECT_LT(RotationErrorDeg(found.rotation, scene.cam2_from_cam1.rotation),
              1e-4);
    EXPECT_LT(
        DirectionErrorDeg(found.translation, scene.cam2_from_cam1.translation),
        1e-4);
    EXPECT_LT((plane.normal - kPlaneNormal).norm(), 1e-6);
  }
}

TEST(RefineOnPlane, IsBetterThanEpipolarLinesAlone) {
  double with_plane = 0, without = 0;
  for (int seed = 0; seed < 50; ++seed) {
    const TwoViewScene scene = PlanarScene(0.5, seed);
    const PointPairs pairs = scene.Pairs();
    const RigidTransform& truth = scene.cam2_from_cam1;
    ScenePlane plane{kPlaneNormal, AllIndices(pairs)};
    const auto error = [&](const RigidTransform& pose) {
      return DirectionErrorDeg(pose.translation, truth.translation);
    };
    with_plane +=
        error(RefineOnPlane(truth, pairs, AllIndices(pairs), {}, &plane)) / 50;
    without +=
        error(RefineRelativePose(truth, pairs, AllIndices(pairs), {})) / 50;
  }
  EXPECT_LT(with_plane, 0.8 * without);
}

TEST(CovarianceOnPlane, StatesTheSpreadOfTheMotion) {
  double squared = 0;
  constexpr int kNumTrials = 200;
  for (int seed = 0; seed < kNumTrials; ++seed) {
    const TwoViewScene scene = PlanarScene(0.5, seed);
    const PointPairs pairs = scene.Pairs();
    ScenePlane plane{kPlaneNormal, AllIndices(pairs)};
    const RigidTransform found = RefineOnPlane(scene.cam2_from_cam1, pairs,
                                               AllIndices(pairs), {}, &plane);
    const auto covariance = CovarianceOnPlane(found, pairs, plane, {});
    ASSERT_TRUE(covariance);
    const Vec5 error = PoseError(found, scene.cam2_from_cam1);
    squared += error.dot(covariance->inverse() * error) / kNumTrials;
  }
  // The mean of chi squared with 5 degrees of freedom, within a fifth.
  EXPECT_GT(squared, 4);
  EXPECT_LT(squared, 6);
}

TEST(RefineOnPlane, PointsOffThePlaneCountWithTheirEpipolarLines) {
  TwoViewSceneOptions options;
  options.planar = true;
  options.num_right = 60;
  options.num_off_plane = 20;
  const TwoViewScene scene = MakeTwoViewScene(options, 7);
  const PointPairs pairs = scene.Pairs();
  ScenePlane plane{kPlaneNormal, {}};
  for (int i = 20; i < 60; ++i) plane.inliers.push_back(i);
  Vec5 step;
  step << 0.01, -0.005, 0.01, 0.02, -0.02;
  const RigidTransform found =
      RefineOnPlane(MovedPose(scene.cam2_from_cam1, step), pairs,
                    AllIndices(pairs), {}, &plane);
  EXPECT_LT(
      DirectionErrorDeg(found.translation, scene.cam2_from_cam1.translation),
      1e-4);
}

}  // namespace
}  // namespace lowlap
