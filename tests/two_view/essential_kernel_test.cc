#include "lowlap/two_view/internal/kernels/essential_kernel.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "lowlap/two_view/internal/search/refine_relative_pose.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::DirectionErrorDeg;
using testing::MakeTwoViewScene;
using testing::RotationErrorDeg;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

TEST(EssentialKernel, FiveExactMatchesGiveTheTruthAmongTheirModels) {
  const TwoViewScene scene = MakeTwoViewScene({}, 1);
  const PointPairs pairs = scene.Pairs();
  const EssentialKernel kernel(pairs);
  for (int first = 0; first + 5 <= 50; first += 5) {
    std::vector<RigidTransform> models;
    kernel.Solve({first, first + 1, first + 2, first + 3, first + 4}, models);
    ASSERT_LE(models.size(),
              static_cast<std::size_t>(EssentialKernel::kMaxModels));
    EXPECT_TRUE(std::any_of(
        models.begin(), models.end(),
        [&](const RigidTransform& model) {
          return RotationErrorDeg(model.rotation,
                                  scene.cam2_from_cam1.rotation) < 1e-5 &&
                 DirectionErrorDeg(model.translation,
                                   scene.cam2_from_cam1.translation) < 1e-5;
        }))
        << first;
    for (const RigidTransform& model : models) {
      for (int i = first; i < first + 5; ++i) {
        EXPECT_EQ(CheckVisibility(model, pairs.x1[i], pairs.x2[i], 0),
                  Visibility::kInFront);
      }
    }
  }
}

TEST(EssentialKernel, ResidualsAreThoseOfTheRefinement) {
  TwoViewSceneOptions options;
  options.num_wrong = 40;
  options.noise_px = 0.5;
  const TwoViewScene scene = MakeTwoViewScene(options, 2);
  PointPairs pairs = scene.Pairs();
  Random random(3);
  for (int i = 0; i < pairs.size(); ++i) {
    Mat2 shape;
    shape << random.Uniform(1, 4), 0.3, 0.3, random.Uniform(1, 4);
    pairs.covariance1.push_back(shape);
    pairs.covariance2.push_back(shape.inverse());
  }
  const EssentialKernel kernel(pairs);
  const SampsonResidual residual(scene.cam2_from_cam1, pairs);
  std::vector<float> squared(pairs.size());
  kernel.SquaredResiduals(scene.cam2_from_cam1, 0, pairs.size(),
                          squared.data());
  // Single precision: x^T E x cancels down to a pixel from numbers around one,
  // which are kFocalPx of them.
  const double rounding_px = 16 * testing::kFocalPx * 6e-8;
  for (int i = 0; i < pairs.size(); ++i) {
    const double exact = std::abs(residual(i));
    EXPECT_NEAR(std::sqrt(squared[i]), exact, rounding_px + 1e-5 * exact) << i;
  }
  for (const int i : kernel.WithinThreshold(scene.cam2_from_cam1, 1.5)) {
    EXPECT_LE(std::abs(residual(i)), 1.5 + rounding_px);
  }
}

// From several times farther than what noise leaves of the rotation.
TEST(EssentialKernel, RefiningCorrectsTheRotation) {
  TwoViewSceneOptions options;
  options.noise_px = 0.5;
  const TwoViewScene scene = MakeTwoViewScene(options, 4);
  const PointPairs pairs = scene.Pairs();
  const EssentialKernel kernel(pairs);
  RigidTransform rough = scene.cam2_from_cam1;
  rough.rotation =
      RotationFromAngleAxis(Vec3(0.003, 0.003, 0)) * rough.rotation;
  const auto refined = kernel.Refine(rough, 8);
  ASSERT_TRUE(refined);
  EXPECT_LT(RotationErrorDeg(refined->rotation, scene.cam2_from_cam1.rotation),
            RotationErrorDeg(rough.rotation, scene.cam2_from_cam1.rotation));
}

TEST(CheckVisibility, KnowsFrontBackAndRaysTooParallelToTell) {
  const RigidTransform pose{Mat3::Identity(), -Vec3::UnitX()};
  const Vec3 x1(0.1, 0.2, 1);
  EXPECT_EQ(CheckVisibility(pose, x1, Vec3(-0.1, 0.2, 1), 0.01),
            Visibility::kInFront);
  EXPECT_EQ(CheckVisibility(pose, x1, Vec3(0.3, 0.2, 1), 0.01),
            Visibility::kBehind);
  EXPECT_EQ(CheckVisibility(pose, x1, Vec3(0.105, 0.2, 1), 0.01),
            Visibility::kUndetermined);
}

}  // namespace
}  // namespace lowlap
