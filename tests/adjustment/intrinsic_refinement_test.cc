#include "lowlap/adjustment/internal/intrinsic_refinement.h"

#include <ceres/manifold_test_utils.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/adjustment/internal/costs/subspace_manifold.h"
#include "test_scene.h"
#include "tests/support/matchers.h"

namespace lowlap {
namespace {

using test::ComparePoses;
using test::MakeTestScene;
using test::TestScene;
using test::TestSceneOptions;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using testing::IsError;
using testing::IsOk;

// Builds structure with the intrinsics as they are, then refines them.
void Adjust(const IntrinsicRefinement& refinement, Scene* scene) {
  AdjustmentOptions options;
  RefineAllIntrinsics(refinement, scene, &options);
  ASSERT_THAT(BuildStructure(scene, {}, {}), IsOk());
  ASSERT_THAT(AdjustScene(scene, options, {}), IsOk());
}

TEST(SubspaceManifoldTest, IsAManifold) {
  Eigen::MatrixXd basis(4, 2);
  basis << 0.6, 0, 0.8, 0, 0, 1, 0, 0;
  const SubspaceManifold manifold(basis);
  Eigen::VectorXd x(4), y(4), delta(2);
  x << 800, 820, 600, -0.1;
  delta << 3, -0.5;
  ASSERT_TRUE(manifold.Plus(x.data(), delta.data(), y.data()));
  using namespace ceres;  // NOLINT: the macro names its matchers so
  EXPECT_THAT_MANIFOLD_INVARIANTS_HOLD(manifold, x, delta, y, 1e-9);
}

TEST(ParseRefinementTest, IsTheInverseOfDescribeParts) {
  for (const char* parts : {"", "focal", "aspect,distortion",
                            "focal,aspect,principal-point,distortion"}) {
    const auto refinement = ParseRefinement(parts);
    ASSERT_THAT(refinement, IsOk());
    EXPECT_EQ(DescribeParts(*refinement), parts);
  }
  EXPECT_EQ(DescribeParts(Others(*ParseRefinement("all"))), "");
  EXPECT_THAT(ParseRefinement("focal,shape"),
              IsError(ErrorCode::kInvalidArgument, "shape"));
}

TEST(SetAdjustedFeaturesTest, CoplanarPairsTakeTheirLinesIn) {
  AdjustmentOptions options;
  ASSERT_THAT(SetAdjustedFeatures({"coplanar"}, &options), IsOk());
  EXPECT_FALSE(options.use_points);
  EXPECT_TRUE(options.use_lines);
  EXPECT_TRUE(options.use_coplanar);
  ASSERT_THAT(SetAdjustedFeatures({"points", "lines"}, &options), IsOk());
  EXPECT_TRUE(options.use_points);
  EXPECT_FALSE(options.use_coplanar);
  const AdjustmentOptions before = options;
  EXPECT_THAT(SetAdjustedFeatures({"points", "planes"}, &options),
              IsError(ErrorCode::kInvalidArgument, "planes"));
  EXPECT_EQ(options.use_lines, before.use_lines);
}

TEST(RefineAllIntrinsicsTest, PinholesGetADistortionToRefine) {
  Scene scene;
  scene.intrinsics[1].model = CameraModel::kPinhole;
  scene.intrinsics[2].model = CameraModel::kSpherical;
  scene.intrinsics[3].model = CameraModel::kRadialK3;
  scene.intrinsics[3].distortion = {0.1, 0.2, 0.3};
  const Scene before = scene;
  AdjustmentOptions options;
  RefineAllIntrinsics({}, &scene, &options);
  EXPECT_TRUE(options.refine_intrinsics.empty());
  RefineAllIntrinsics({true}, &scene, &options);
  EXPECT_EQ(options.refine_intrinsics.size(), 2u);  // not the panorama
  EXPECT_TRUE(scene == before);
  EXPECT_TRUE(scene.given_intrinsics.empty());
  RefineAllIntrinsics({true, false, true}, &scene, &options);
  EXPECT_EQ(scene.intrinsics.at(1).model, CameraModel::kRadialK1);
  EXPECT_THAT(scene.intrinsics.at(1).distortion, ElementsAre(0));
  EXPECT_TRUE(scene.intrinsics.at(3) == before.intrinsics.at(3));
  RestoreGivenIntrinsics(&scene);
  EXPECT_TRUE(scene == before);
}

// However often a scene is adjusted, the calibration as given is kept.
TEST(RestoreGivenIntrinsicsTest, UndoesEveryRefinement) {
  TestSceneOptions scene_options;
  scene_options.noise_px = 0.3;
  TestScene test = MakeTestScene(scene_options);
  test.scene.intrinsics.at(7).fx_px *= 1.02;
  const auto given = test.scene.intrinsics;
  Adjust({true, false, true}, &test.scene);
  const Intrinsic first = test.scene.intrinsics.at(7);
  EXPECT_TRUE(test.scene.given_intrinsics == given);
  Adjust({false, true, false, true}, &test.scene);
  EXPECT_FALSE(test.scene.intrinsics.at(7) == first);
  EXPECT_TRUE(test.scene.given_intrinsics == given);
  RestoreGivenIntrinsics(&test.scene);
  EXPECT_TRUE(test.scene.intrinsics == given);
  EXPECT_TRUE(test.scene.given_intrinsics.empty());
  Adjust({}, &test.scene);
  EXPECT_TRUE(test.scene.intrinsics == given);
  EXPECT_TRUE(test.scene.given_intrinsics.empty());
}

TEST(RefineAllIntrinsicsTest, AWrongFocalLengthIsFound) {
  for (const double factor : {0.97, 1.03}) {
    for (const bool lines_only : {false, true}) {
      SCOPED_TRACE(::testing::Message() << factor << " " << lines_only);
      TestSceneOptions scene_options;
      scene_options.noise_px = 0.3;
      scene_options.pairs_per_triplet = 8;
      if (lines_only) scene_options.num_points = 0;
      TestScene test = MakeTestScene(scene_options);
      const Intrinsic truth = test.scene.intrinsics.at(7);
      Intrinsic& intrinsic = test.scene.intrinsics.at(7);
      intrinsic.fx_px *= factor;
      intrinsic.fy_px *= factor;
      Scene fixed = test.scene;
      Adjust({true}, &test.scene);
      EXPECT_NEAR(intrinsic.fx_px / truth.fx_px, 1, 0.003);
      EXPECT_NEAR(intrinsic.fx_px / intrinsic.fy_px, truth.fx_px / truth.fy_px,
                  1e-9);
      EXPECT_EQ(intrinsic.principal_point_px, truth.principal_point_px);
      Adjust({}, &fixed);
      EXPECT_EQ(fixed.intrinsics.at(7).fx_px, factor * truth.fx_px);
      EXPECT_LT(ComparePoses(test.true_poses, test.scene).mean_center,
                0.5 * ComparePoses(test.true_poses, fixed).mean_center);
    }
  }
}

// Every solve goes on from where the last one ended, lines too.
TEST(RefineAllIntrinsicsTest, SolvesWithoutRoundsBetweenThemAgree) {
  TestSceneOptions scene_options;
  scene_options.noise_px = 0.3;
  scene_options.pairs_per_triplet = 8;
  TestScene test = MakeTestScene(scene_options);
  Intrinsic& intrinsic = test.scene.intrinsics.at(7);
  const double truth_px = intrinsic.fx_px;
  intrinsic.fx_px *= 0.97;
  intrinsic.fy_px *= 0.97;
  AdjustmentOptions options;
  options.max_outlier_rounds = 0;
  RefineAllIntrinsics({true}, &test.scene, &options);
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  const auto summary = AdjustScene(&test.scene, options, {});
  ASSERT_THAT(summary, IsOk());
  EXPECT_NEAR(intrinsic.fx_px / truth_px, 1, 0.003);
  EXPECT_LT(summary->lines.final_rmse_px, 0.5);
  ASSERT_GE(summary->solves.size(), 2u);
  EXPECT_LT(summary->solves[1].initial_cost,
            1.5 * summary->solves[0].final_cost);
}

TEST(RefineAllIntrinsicsTest, AnUnknownDistortionIsFound) {
  TestSceneOptions scene_options;
  scene_options.noise_px = 0.3;
  scene_options.model = CameraModel::kRadialK1;
  scene_options.distortion = {-0.1};
  TestScene test = MakeTestScene(scene_options);
  const Intrinsic truth = test.scene.intrinsics.at(7);
  Intrinsic& intrinsic = test.scene.intrinsics.at(7);
  intrinsic.model = CameraModel::kPinhole;
  intrinsic.distortion.clear();
  intrinsic.fx_px *= 1.02;
  intrinsic.fy_px *= 1.02;
  Adjust({true, false, true}, &test.scene);
  EXPECT_EQ(intrinsic.model, CameraModel::kRadialK1);
  EXPECT_NEAR(intrinsic.distortion[0], -0.1, 0.004);
  EXPECT_NEAR(intrinsic.fx_px / truth.fx_px, 1, 0.003);
}

TEST(RefineAllIntrinsicsTest, WithoutItNothingChanges) {
  TestSceneOptions scene_options;
  scene_options.noise_px = 0.3;
  scene_options.pairs_per_triplet = 4;
  TestScene plain = MakeTestScene(scene_options);
  TestScene named = MakeTestScene(scene_options);
  const auto intrinsics = plain.scene.intrinsics;
  AdjustmentOptions options;
  options.principal_point_stddev = 0;
  ASSERT_THAT(BuildStructure(&plain.scene, {}, {}), IsOk());
  ASSERT_THAT(AdjustScene(&plain.scene, options, {}), IsOk());
  // Named, with nothing to refine.
  options = {};
  options.refine_intrinsics[7] = {};
  ASSERT_THAT(BuildStructure(&named.scene, {}, {}), IsOk());
  ASSERT_THAT(AdjustScene(&named.scene, options, {}), IsOk());
  EXPECT_TRUE(plain.scene == named.scene);
  EXPECT_TRUE(plain.scene.intrinsics == intrinsics);
}

TEST(LargestIntrinsicShiftTest, IsThatOfTheCorners) {
  Scene scene;
  Intrinsic& intrinsic = scene.intrinsics[4];
  intrinsic.width_px = 800;
  intrinsic.height_px = 600;
  intrinsic.fx_px = intrinsic.fy_px = 1000;
  intrinsic.principal_point_px = {400, 300};
  EXPECT_EQ(LargestIntrinsicShiftPx(scene), 0);
  scene.given_intrinsics[4] = intrinsic;
  EXPECT_LT(LargestIntrinsicShiftPx(scene), 1e-9);
  intrinsic.fx_px = intrinsic.fy_px = 1010;
  EXPECT_NEAR(LargestIntrinsicShiftPx(scene), 5, 1e-9);
}

TEST(DescribeIntrinsicChangesTest, NamesWhatMoved) {
  Scene scene;
  Intrinsic& intrinsic = scene.intrinsics[4];
  intrinsic.fx_px = 800;
  intrinsic.fy_px = 801;
  EXPECT_TRUE(DescribeIntrinsicChanges(scene).empty());
  scene.given_intrinsics[4] = intrinsic;
  EXPECT_TRUE(DescribeIntrinsicChanges(scene).empty());
  intrinsic.fx_px = 810;
  intrinsic.model = CameraModel::kRadialK1;
  intrinsic.distortion = {-0.05};
  const auto lines = DescribeIntrinsicChanges(scene);
  ASSERT_EQ(lines.size(), 1u);
  EXPECT_THAT(lines[0], HasSubstr("intrinsic 4"));
  EXPECT_THAT(lines[0], HasSubstr("focal 800.00, 801.00 -> 810.00, 801.00"));
  EXPECT_THAT(lines[0], HasSubstr("distortion 0 -> -0.05"));
}

}  // namespace
}  // namespace lowlap
