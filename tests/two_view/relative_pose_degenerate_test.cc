#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <algorithm>
#include <limits>

#include "lowlap/two_view/internal/relative_pose_estimator.h"
#include "tests/support/matchers.h"
#include "tests/support/num_trials.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::AmbiguousPlane;
using testing::DirectionErrorDeg;
using testing::IsError;
using testing::IsOk;
using testing::MakeTwoViewScene;
using testing::NumTrials;
using testing::RotationErrorDeg;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

double PoseErrorDeg(const RelativePose& pose, const TwoViewScene& scene) {
  return RotationErrorDeg(pose.rotation, scene.cam2_from_cam1.rotation) +
         DirectionErrorDeg(pose.direction, scene.cam2_from_cam1.translation);
}

TwoViewSceneOptions PlanarOptions() {
  TwoViewSceneOptions options;
  options.planar = true;
  options.noise_px = 0.3;
  return options;
}

TEST(EstimateRelativePose, PlanarSceneIsDecidedByVisibility) {
  // The mirror motion would put part of the points behind a camera.
  for (int seed = 0; seed < 8; ++seed) {
    const TwoViewScene scene = MakeTwoViewScene(PlanarOptions(), seed);
    const auto result = EstimateRelativePose(scene.Input(), {}, seed);
    ASSERT_THAT(result, IsOk());
    EXPECT_EQ(result->geometry, TwoViewGeometry::kPlanar) << seed;
    EXPECT_GT(result->num_plane_inliers, 180);
    EXPECT_LT(PoseErrorDeg(result->pose, scene), 1) << seed;
  }
}

TEST(EstimateRelativePose, AmbiguousPlanarSceneKeepsBothMotions) {
  for (int seed = 0; seed < 8; ++seed) {
    const TwoViewScene scene = MakeTwoViewScene(AmbiguousPlane(), seed);
    const auto result = EstimateRelativePose(scene.Input(), {}, seed);
    ASSERT_THAT(result, IsOk());
    EXPECT_EQ(result->geometry, TwoViewGeometry::kAmbiguousPlane) << seed;
    ASSERT_EQ(result->alternatives.size(), 1u) << seed;
    EXPECT_LT(std::min(PoseErrorDeg(result->pose, scene),
                       PoseErrorDeg(result->alternatives[0], scene)),
              1)
        << seed;
    EXPECT_GT(RotationErrorDeg(result->pose.rotation,
                               result->alternatives[0].rotation),
              3);
  }
}

TEST(EstimateRelativePose, EveryAlternativeIsMeaningful) {
  // So few matches that the second motion of a plane may have no more inliers
  // than a sample: its NFA is infinite, and no scene can hold it.
  int num_planar = 0;
  for (int seed = 0; seed < 300; ++seed) {
    TwoViewSceneOptions options = AmbiguousPlane();
    options.num_right = 7 + seed % 4;
    options.num_wrong = 4;
    options.noise_px = 1;
    const TwoViewScene scene = MakeTwoViewScene(options, 400 + seed);
    TwoViewOptions quick;
    quick.max_samples = 100;
    const auto result = EstimateRelativePose(scene.Input(), quick, seed);
    if (!result) continue;
    EXPECT_LT(result->pose.log10_nfa, 0) << seed;
    for (const RelativePose& other : result->alternatives) {
      EXPECT_LT(other.log10_nfa, 0) << seed;
    }
    num_planar += result->geometry == TwoViewGeometry::kPlanar ||
                  result->geometry == TwoViewGeometry::kAmbiguousPlane;
  }
  EXPECT_GT(num_planar, 0);
}

TEST(ImproveRelativePose, APoseThatNoMatchFitsComesBackAsItWas) {
  TwoViewSceneOptions options;
  options.num_right = 40;
  const TwoViewScene scene = MakeTwoViewScene(options, 360);
  const auto result = EstimateRelativePose(scene.Input(), {}, 1);
  ASSERT_THAT(result, IsOk());
  TwoViewSceneOptions wrong;
  wrong.num_right = 0;
  wrong.num_wrong = 6;
  for (int seed = 0; seed < 50; ++seed) {
    const TwoViewScene other = MakeTwoViewScene(wrong, 361 + seed);
    const RelativePose improved =
        ImproveRelativePose(other.Input(), result->pose, false, {});
    EXPECT_TRUE(improved == result->pose || improved.point_inliers.size() > 5u);
  }
}

TEST(EstimateRelativePose, AFewPointsOffThePlaneDecide) {
  for (int seed = 0; seed < 8; ++seed) {
    TwoViewSceneOptions options = AmbiguousPlane();
    options.num_off_plane = 40;
    const TwoViewScene scene = MakeTwoViewScene(options, 100 + seed);
    const auto result = EstimateRelativePose(scene.Input(), {}, seed);
    ASSERT_THAT(result, IsOk());
    EXPECT_EQ(result->geometry, TwoViewGeometry::kPlanar) << seed;
    EXPECT_TRUE(result->alternatives.empty());
    EXPECT_LT(PoseErrorDeg(result->pose, scene), 1.5) << seed;
  }
}

TEST(EstimateRelativePose, WhatOnePlaneLeavesOpenIsSaid) {
  int num_inside = 0;
  constexpr int kNumTrials = 40;
  for (int seed = 0; seed < kNumTrials; ++seed) {
    TwoViewSceneOptions options = PlanarOptions();
    options.num_wrong = 40;
    const TwoViewScene scene = MakeTwoViewScene(options, 500 + seed);
    const auto result = EstimateRelativePose(scene.Input(), {}, seed);
    ASSERT_THAT(result, IsOk());
    EXPECT_TRUE(result->is_of_one_plane);
    ASSERT_TRUE(result->pose.covariance);
    const Eigen::Matrix<double, 5, 1> error =
        PoseError(result->pose.Cam2FromCam1(), scene.cam2_from_cam1);
    const double squared =
        error.dot(result->pose.covariance->ldlt().solve(error));
    num_inside += squared < 11.07 ? 1 : 0;  // 95 % of 5 degrees of freedom
  }
  EXPECT_GE(num_inside, 34);
}

TEST(EstimateRelativePose, PointsOffAPlaneAreMoreThanOnePlane) {
  for (int seed = 0; seed < 8; ++seed) {
    TwoViewSceneOptions options = PlanarOptions();
    options.num_off_plane = 15;
    const TwoViewScene scene = MakeTwoViewScene(options, 600 + seed);
    const auto result = EstimateRelativePose(scene.Input(), {}, seed);
    ASSERT_THAT(result, IsOk());
    EXPECT_FALSE(result->is_of_one_plane) << seed;
  }
}

TEST(EstimateRelativePose, PureRotationIsRecognised) {
  for (int seed = 0; seed < 5; ++seed) {
    TwoViewSceneOptions options;
    options.baseline = 0;
    options.num_wrong = 60;
    options.noise_px = 0.4;
    const TwoViewScene scene = MakeTwoViewScene(options, 200 + seed);
    const auto result = EstimateRelativePose(scene.Input(), {}, seed);
    ASSERT_THAT(result, IsOk());
    EXPECT_EQ(result->geometry, TwoViewGeometry::kRotationOnly) << seed;
    EXPECT_FALSE(result->HasDirection());
    EXPECT_LT(
        RotationErrorDeg(result->pose.rotation, scene.cam2_from_cam1.rotation),
        0.2);
  }
}

TEST(EstimateRelativePose, ACopyOfAnImageHasNoDirection) {
  // Nothing moves, or by what coordinates in single precision round off.
  for (const bool rounded : {false, true}) {
    for (int seed = 0; seed < 5; ++seed) {
      TwoViewSceneOptions options;
      options.num_wrong = 20;
      TwoViewScene scene = MakeTwoViewScene(options, 230 + seed);
      for (int n = 0; n < scene.num_right; ++n) {
        const Vec3& x = scene.features1.points[n];
        scene.features2.points[n] =
            rounded ? Vec3(x.cast<float>().cast<double>()) : x;
      }
      const auto result = EstimateRelativePose(scene.Input(), {}, seed);
      ASSERT_THAT(result, IsOk());
      EXPECT_EQ(result->geometry, TwoViewGeometry::kRotationOnly) << seed;
      EXPECT_LT(RotationErrorDeg(result->pose.rotation, Mat3::Identity()),
                0.01);
    }
  }
}

TEST(EstimateRelativePose, PureRotationsAreRarelyTakenForTranslations) {
  // One in a thousand is promised.
  int num_false = 0;
  for (int seed = 0; seed < NumTrials(100); ++seed) {
    TwoViewSceneOptions options;
    options.baseline = 0;
    options.num_right = 20 + 10 * (seed % 10);
    options.num_wrong = seed % 3 * 15;
    options.noise_px = 0.1 * (1 + seed % 7);
    const TwoViewScene scene = MakeTwoViewScene(options, 500 + seed);
    TwoViewOptions quick;
    quick.max_samples = 300;
    const auto result = EstimateRelativePose(scene.Input(), quick, seed);
    num_false += result && result->HasDirection();
  }
  // Two would have a probability of 0.005.
  EXPECT_LE(num_false, 1);
}

TEST(EstimateRelativePose, SmallParallaxIsSeenBesideGreatNoise) {
  // Beside the rotation that fits best, depths from 4 to 9 leave about a pixel.
  int num_seen = 0;
  constexpr int kTrials = 20;
  for (int seed = 0; seed < kTrials; ++seed) {
    TwoViewSceneOptions options;
    options.baseline = 0.02;
    options.noise_px = 0.3 + 0.01 * seed;
    const TwoViewScene scene = MakeTwoViewScene(options, 700 + seed);
    const auto result = EstimateRelativePose(scene.Input(), {}, seed);
    ASSERT_THAT(result, IsOk());
    num_seen += result->HasDirection();
  }
  // It has to prove itself against all directions that noise could pretend.
  EXPECT_GE(num_seen, kTrials - 1);
}

TEST(EstimateRelativePose, BaselineBelowTheNoiseIsPureRotation) {
  TwoViewSceneOptions options;
  options.baseline = 0.0005;  // a tenth of a pixel of parallax
  options.noise_px = 0.5;
  const TwoViewScene scene = MakeTwoViewScene(options, 210);
  const auto result = EstimateRelativePose(scene.Input(), {}, 1);
  ASSERT_THAT(result, IsOk());
  EXPECT_EQ(result->geometry, TwoViewGeometry::kRotationOnly);
}

TEST(EstimateRelativePose, AShortBaselineAboveTheNoiseHasADirection) {
  TwoViewSceneOptions options;
  options.baseline = 0.03;  // five to ten pixels of parallax
  options.noise_px = 0.3;
  const TwoViewScene scene = MakeTwoViewScene(options, 220);
  const auto result = EstimateRelativePose(scene.Input(), {}, 1);
  ASSERT_THAT(result, IsOk());
  EXPECT_TRUE(result->HasDirection());
  EXPECT_LT(DirectionErrorDeg(result->pose.direction,
                              scene.cam2_from_cam1.translation),
            10);
}

TEST(EstimateRelativePose, MatchesOfChanceAreInsufficientData) {
  for (int seed = 0; seed < 6; ++seed) {
    TwoViewSceneOptions options;
    options.num_right = 0;
    options.num_wrong = 80;
    const TwoViewScene scene = MakeTwoViewScene(options, 300 + seed);
    TwoViewOptions quick;
    quick.max_samples = 2000;
    EXPECT_THAT(EstimateRelativePose(scene.Input(), quick, seed),
                IsError(ErrorCode::kInsufficientData, "better than chance"));
  }
}

TEST(EstimateRelativePose, FiveMatchesAreInsufficientData) {
  TwoViewSceneOptions options;
  options.num_right = 5;
  const TwoViewScene scene = MakeTwoViewScene(options, 310);
  EXPECT_THAT(
      EstimateRelativePose(scene.Input(), {}, 1),
      IsError(ErrorCode::kInsufficientData, "5 usable points and crossings"));
}

TEST(EstimateRelativePose, PointsThatCannotBeNormalisedAreNotUsed) {
  TwoViewSceneOptions options;
  options.num_right = 40;
  TwoViewScene scene = MakeTwoViewScene(options, 320);
  for (int n = 0; n < 10; ++n) scene.features1.points[n].setZero();
  const auto result = EstimateRelativePose(scene.Input(), {}, 1);
  ASSERT_THAT(result, IsOk());
  EXPECT_EQ(result->num_matches, 30);
  EXPECT_LT(PoseErrorDeg(result->pose, scene), 1e-5);
  EXPECT_EQ(result->pose.point_inliers.front().first, 10u);
}

TEST(EstimateRelativePose, CollinearPointsAreInsufficientData) {
  TwoViewSceneOptions options;
  options.num_right = 60;
  TwoViewScene scene = MakeTwoViewScene(options, 330);
  for (int n = 0; n < 60; ++n) {
    const Vec3 x = Vec3(-1, 0.3, 5) + 0.03 * n * Vec3(1, 0.2, 0.5);
    const Vec3 y = scene.cam2_from_cam1 * x;
    scene.features1.points[n] = x / x.z();
    scene.features2.points[n] = y / y.z();
  }
  const auto result = EstimateRelativePose(scene.Input(), {}, 1);
  if (result) {
    // Any pose through the line would do; none may claim certainty.
    EXPECT_FALSE(result->pose.covariance &&
                 result->pose.covariance->trace() < 1e-4);
  } else {
    EXPECT_EQ(result.error().code, ErrorCode::kInsufficientData);
  }
}

TEST(EstimateRelativePose, OnePointManyTimesIsInsufficientData) {
  TwoViewSceneOptions options;
  options.num_right = 60;
  TwoViewScene scene = MakeTwoViewScene(options, 340);
  for (int n = 1; n < 60; ++n) {
    scene.features1.points[n] = scene.features1.points[0];
    scene.features2.points[n] = scene.features2.points[0];
  }
  EXPECT_THAT(EstimateRelativePose(scene.Input(), {}, 1),
              IsError(ErrorCode::kInsufficientData, "relative pose"));
}

TEST(EstimateRelativePose, BadArgumentsAreNamed) {
  const TwoViewScene scene = MakeTwoViewScene({}, 350);
  TwoViewInput input = scene.Input();
  input.point_matches.push_back({100000, 0});
  EXPECT_THAT(EstimateRelativePose(input, {}, 1),
              IsError(ErrorCode::kInvalidArgument, "100000-0"));
  input = scene.Input();
  input.features2 = nullptr;
  EXPECT_THAT(EstimateRelativePose(input, {}, 1),
              IsError(ErrorCode::kInvalidArgument, "no features"));
  input = scene.Input();
  input.image_size1_px = Vec2::Zero();
  EXPECT_THAT(EstimateRelativePose(input, {}, 1),
              IsError(ErrorCode::kInvalidArgument, "no size"));
  TwoViewOptions options;
  options.confidence = 1;
  EXPECT_THAT(EstimateRelativePose(scene.Input(), options, 1),
              IsError(ErrorCode::kInvalidArgument, "confidence"));
  options = {};
  options.max_threshold_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THAT(options.Validate(),
              IsError(ErrorCode::kInvalidArgument, "max_threshold_px"));
}

TEST(TwoViewGeometryName, NamesEveryGeometry) {
  EXPECT_STREQ(TwoViewGeometryName(TwoViewGeometry::kGeneral), "general");
  EXPECT_STREQ(TwoViewGeometryName(TwoViewGeometry::kPlanar), "planar");
  EXPECT_STREQ(TwoViewGeometryName(TwoViewGeometry::kAmbiguousPlane),
               "ambiguous_plane");
  EXPECT_STREQ(TwoViewGeometryName(TwoViewGeometry::kRotationOnly),
               "rotation_only");
}

}  // namespace
}  // namespace lowlap
