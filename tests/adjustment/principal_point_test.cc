#include <gtest/gtest.h>

#include <limits>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/adjustment/internal/costs/intrinsic_freedom.h"
#include "test_scene.h"
#include "tests/support/matchers.h"

namespace lowlap {
namespace {

using test::ComparePoses;
using test::MakeTestScene;
using test::TestScene;
using test::TestSceneOptions;
using testing::IsOk;

constexpr IntrinsicId kIntrinsic = 7;

Vec2 Adjusted(Scene* scene, double stddev) {
  AdjustmentOptions options;
  options.principal_point_stddev = stddev;
  EXPECT_THAT(BuildStructure(scene, {}, {}), IsOk());
  EXPECT_THAT(AdjustScene(scene, options, {}), IsOk());
  return scene->intrinsics.at(kIntrinsic).principal_point_px;
}

TEST(PrincipalPointTest, ImagesThatKnowBetterMoveIt) {
  TestSceneOptions options;
  options.noise_px = 0.2;
  TestScene test = MakeTestScene(options);
  Intrinsic& intrinsic = test.scene.intrinsics.at(kIntrinsic);
  const Vec2 truth = intrinsic.principal_point_px;
  intrinsic.principal_point_px += Vec2(3, -2);
  const Vec2 given = intrinsic.principal_point_px;
  Scene held = test.scene;
  const Vec2 moved = Adjusted(&test.scene, 0.003);
  EXPECT_LT((moved - truth).norm(), 0.3 * (given - truth).norm());
  EXPECT_EQ(Adjusted(&held, 0), given);
  EXPECT_LT(ComparePoses(test.true_poses, test.scene).mean_center,
            0.7 * ComparePoses(test.true_poses, held).mean_center);
}

TEST(PrincipalPointTest, TheBetterItIsKnownTheLessItMoves) {
  TestSceneOptions options;
  options.noise_px = 0.2;
  TestScene test = MakeTestScene(options);
  Intrinsic& intrinsic = test.scene.intrinsics.at(kIntrinsic);
  intrinsic.principal_point_px += Vec2(3, -2);
  const Vec2 given = intrinsic.principal_point_px;
  double last = std::numeric_limits<double>::infinity();
  for (const double stddev : {1e-2, 1e-4, 1e-5, 1e-7}) {
    Scene scene = test.scene;
    const double shift = (Adjusted(&scene, stddev) - given).norm();
    EXPECT_LT(shift, last);
    last = shift;
  }
  EXPECT_LT(last, 1e-3);
}

TEST(PrincipalPointTest, ExactDataLeaveItWhereItIs) {
  TestScene test = MakeTestScene({});
  const Vec2 given = test.scene.intrinsics.at(kIntrinsic).principal_point_px;
  test::PerturbPoses(0.005, 0.03, 5, &test.scene);
  const Vec2 moved = Adjusted(&test.scene, 0.0003);
  EXPECT_LT((moved - given).norm(), 1e-3);
}

TEST(PrincipalPointTest, MovesOnlyOnRequest) {
  const TestScene test = MakeTestScene({});
  const CameraSet cameras(test.scene);
  IntrinsicState intrinsic = cameras.intrinsics.front();
  AdjustmentOptions options;
  options.principal_point_stddev = 0.001;
  EXPECT_DOUBLE_EQ(PrincipalPointStddevPx(options, intrinsic),
                   0.001 * intrinsic.value.ImageDiagonal());
  EXPECT_TRUE(RefinementOf(options, intrinsic).principal_point);
  EXPECT_FALSE(RefinementOf(options, intrinsic).focal);

  // A deviation on request counts whatever else is refined.
  options.refine_intrinsics[intrinsic.id].focal = true;
  EXPECT_TRUE(RefinementOf(options, intrinsic).principal_point);
  EXPECT_TRUE(RefinementOf(options, intrinsic).focal);

  AdjustmentOptions held;
  EXPECT_FALSE(held.MovesIntrinsics());
  EXPECT_FALSE(RefinementOf(held, intrinsic).Any());
  held.refine_intrinsics[intrinsic.id].focal = true;
  EXPECT_FALSE(RefinementOf(held, intrinsic).principal_point);
  EXPECT_EQ(PrincipalPointStddevPx(held, intrinsic), 0);

  intrinsic.value.model = CameraModel::kSpherical;
  EXPECT_EQ(PrincipalPointStddevPx(options, intrinsic), 0);
  EXPECT_FALSE(RefinementOf(options, intrinsic).Any());
}

TEST(PrincipalPointTest, TheCostAndItsDerivative) {
  const TestScene test = MakeTestScene({});
  const IntrinsicState intrinsic = CameraSet(test.scene).intrinsics.front();
  const PrincipalPointCost cost(intrinsic, 0.5);
  IntrinsicParameters moved = intrinsic.parameters;
  moved[2] += 1;
  moved[3] -= 2;
  const double* const blocks[] = {moved.data()};
  double residual[2];
  Eigen::Matrix<double, 2, Eigen::Dynamic, Eigen::RowMajor> jacobian(
      2, intrinsic.ParameterCount());
  double* jacobians[] = {jacobian.data()};
  ASSERT_TRUE(cost.Evaluate(blocks, residual, jacobians));
  EXPECT_DOUBLE_EQ(residual[0], 2);
  EXPECT_DOUBLE_EQ(residual[1], -4);
  Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(2, jacobian.cols());
  expected(0, 2) = expected(1, 3) = 2;
  EXPECT_EQ(jacobian, expected);
}

TEST(PrincipalPointTest, ANegativeDeviationIsRefused) {
  AdjustmentOptions options;
  options.principal_point_stddev = -1;
  EXPECT_FALSE(options.Validate());
}

}  // namespace
}  // namespace lowlap
