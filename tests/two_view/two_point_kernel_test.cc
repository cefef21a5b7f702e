#include "lowlap/two_view/internal/kernels/two_point_kernel.h"

#include <gtest/gtest.h>

#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::DirectionErrorDeg;
using testing::MakeTwoViewScene;
using testing::RotationErrorDeg;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

TEST(TwoPointKernel, TwoExactMatchesGiveTheDirection) {
  const TwoViewScene scene = MakeTwoViewScene({}, 1);
  const PointPairs pairs = scene.Pairs();
  const EssentialKernel points(pairs);
  const TwoPointKernel kernel(points, scene.cam2_from_cam1.rotation, {});
  EXPECT_EQ(kernel.NumData(), pairs.size());
  for (int first = 0; first < 20; first += 2) {
    std::vector<RigidTransform> models;
    kernel.Solve({first, first + 1}, models);
    ASSERT_EQ(models.size(), 1u);  // the other sign sees both behind
    EXPECT_EQ(models[0].rotation, scene.cam2_from_cam1.rotation);
    EXPECT_LT(DirectionErrorDeg(models[0].translation,
                                scene.cam2_from_cam1.translation),
              1e-6);
  }
}

TEST(TwoPointKernel, MatchesInOneEpipolarPlaneGiveNone) {
  const TwoViewScene scene = MakeTwoViewScene({}, 2);
  PointPairs pairs = scene.Pairs();
  // Another point of the ray of the first one.
  const Vec3 y = scene.cam2_from_cam1.rotation * (3.0 * pairs.x1[0]) +
                 scene.cam2_from_cam1.translation;
  pairs.x1[1] = pairs.x1[0];
  pairs.x2[1] = y / y.z();
  const EssentialKernel points(pairs);
  const TwoPointKernel kernel(points, scene.cam2_from_cam1.rotation, {});
  std::vector<RigidTransform> models;
  kernel.Solve({0, 0}, models);
  EXPECT_TRUE(models.empty());
  kernel.Solve({0, 1}, models);
  for (const RigidTransform& model : models) {
    // Only rounding tells these planes apart: any direction within them.
    const Vec3 normal =
        (scene.cam2_from_cam1.rotation * pairs.x1[0]).cross(pairs.x2[0]);
    EXPECT_NEAR(model.translation.dot(normal.normalized()), 0, 1e-6);
  }
}

TEST(TwoPointKernel, RefinesTheRotationToo) {
  TwoViewSceneOptions options;
  options.noise_px = 0.3;
  const TwoViewScene scene = MakeTwoViewScene(options, 3);
  const PointPairs pairs = scene.Pairs();
  const EssentialKernel points(pairs);
  // Several times what noise leaves of the rotation.
  const Mat3 off = RotationFromAngleAxis(Vec3(0.003, -0.003, 0)) *
                   scene.cam2_from_cam1.rotation;
  const TwoPointKernel kernel(points, off, {});
  const auto refined =
      kernel.Refine({off, scene.cam2_from_cam1.translation}, 8);
  ASSERT_TRUE(refined);
  EXPECT_LT(RotationErrorDeg(refined->rotation, scene.cam2_from_cam1.rotation),
            RotationErrorDeg(off, scene.cam2_from_cam1.rotation));
}

}  // namespace
}  // namespace lowlap
