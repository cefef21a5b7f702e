#include "lowlap/scene/intrinsic.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lowlap/core/internal/random.h"
#include "lowlap/scene/features.h"
#include "support/matchers.h"
#include "support/random_vectors.h"

namespace lowlap {
namespace {

using testing::IsOk;
using testing::VectorNear;

constexpr CameraModel kModels[] = {
    CameraModel::kPinhole, CameraModel::kRadialK1, CameraModel::kRadialK3,
    CameraModel::kBrownT2, CameraModel::kFisheye,  CameraModel::kSpherical};

Intrinsic MakeIntrinsic(CameraModel model, std::vector<double> distortion) {
  Intrinsic intrinsic;
  intrinsic.model = model;
  intrinsic.width_px = 640;
  intrinsic.height_px = 480;
  if (model != CameraModel::kSpherical) {
    intrinsic.fx_px = 500;
    intrinsic.fy_px = 510;
    intrinsic.principal_point_px = {320, 240};
  }
  intrinsic.distortion = std::move(distortion);
  return intrinsic;
}

TEST(CameraModel, NamesGoBothWays) {
  for (const CameraModel model : kModels) {
    EXPECT_EQ(CameraModelFromName(CameraModelName(model)), model);
  }
  EXPECT_EQ(CameraModelFromName("pinhole_radial_k2"), std::nullopt);
}

// OpenMVG's own numbers: a point at (0.4, -0.25, 5.3) in the camera, seen with
// K3 distortion and written with six decimals.
TEST(Intrinsic, AgreesWithOpenMvgOnK3) {
  Intrinsic intrinsic =
      MakeIntrinsic(CameraModel::kRadialK3, {-0.1, 0.01, 0.0});
  intrinsic.fy_px = 500;
  EXPECT_THAT(intrinsic.Project({0.4, -0.25, 5.3}),
              VectorNear(Vec2(357.705982, 216.433761), 1e-6));
  EXPECT_THAT(intrinsic.Project({0.5, -0.25, 5.0}),
              VectorNear(Vec2(369.937578, 215.031211), 1e-6));
}

// The formulas of the file format, written out once more and independently.
TEST(Intrinsic, ProjectsByTheFormulas) {
  const Vec3 point(0.6, -0.4, 2.0);
  const double x = 0.3, y = -0.2, r2 = x * x + y * y, r = std::sqrt(r2);
  const auto expect_distorted = [&](const Intrinsic& intrinsic, double xd,
                                    double yd) {
    EXPECT_THAT(intrinsic.Project(point),
                VectorNear(Vec2(500 * xd + 320, 510 * yd + 240), 1e-10))
        << CameraModelName(intrinsic.model);
  };
  expect_distorted(MakeIntrinsic(CameraModel::kPinhole, {}), x, y);
  const double k1_factor = 1 + 0.1 * r2;
  expect_distorted(MakeIntrinsic(CameraModel::kRadialK1, {0.1}), x * k1_factor,
                   y * k1_factor);
  const double a = 1 + 0.1 * r2 - 0.2 * std::pow(r2, 2) + 0.3 * std::pow(r2, 3);
  expect_distorted(MakeIntrinsic(CameraModel::kRadialK3, {0.1, -0.2, 0.3}),
                   x * a, y * a);
  const double t1 = 0.01, t2 = -0.02;
  expect_distorted(
      MakeIntrinsic(CameraModel::kBrownT2, {0.1, -0.2, 0.3, t1, t2}),
      x * a + t2 * (r2 + 2 * x * x) + 2 * t1 * x * y,
      y * a + t1 * (r2 + 2 * y * y) + 2 * t2 * x * y);
  const double theta = std::atan(r);
  const double theta_d = theta + 0.1 * std::pow(theta, 3) -
                         0.05 * std::pow(theta, 5) + 0.02 * std::pow(theta, 7) -
                         0.01 * std::pow(theta, 9);
  expect_distorted(
      MakeIntrinsic(CameraModel::kFisheye, {0.1, -0.05, 0.02, -0.01}),
      x * theta_d / r, y * theta_d / r);
}

TEST(Intrinsic, SphericalProjectsByTheFormulas) {
  Intrinsic intrinsic = MakeIntrinsic(CameraModel::kSpherical, {});
  intrinsic.width_px = 2000;
  intrinsic.height_px = 1000;
  EXPECT_THAT(intrinsic.Project({0, 0, 1}), VectorNear(Vec2(1000, 500), 1e-9));
  // A quarter turn to the right is a quarter of the width; down is down.
  EXPECT_THAT(intrinsic.Project({1, 0, 0}), VectorNear(Vec2(1500, 500), 1e-9));
  EXPECT_THAT(intrinsic.Project({-1, 0, 0}), VectorNear(Vec2(500, 500), 1e-9));
  EXPECT_THAT(intrinsic.Project({0, 1, 1}), VectorNear(Vec2(1000, 750), 1e-9));
  EXPECT_NEAR(intrinsic.MeanFocalPx(), 2000 / (2 * kPi), 1e-9);
}

TEST(Intrinsic, BearingInvertsProjection) {
  const Intrinsic intrinsics[] = {
      MakeIntrinsic(CameraModel::kPinhole, {}),
      MakeIntrinsic(CameraModel::kRadialK1, {-0.25}),
      MakeIntrinsic(CameraModel::kRadialK1, {0.8}),
      MakeIntrinsic(CameraModel::kRadialK3, {-0.3, 0.15, -0.02}),
      MakeIntrinsic(CameraModel::kBrownT2, {-0.2, 0.1, 0.01, 0.01, -0.02}),
      MakeIntrinsic(CameraModel::kFisheye, {0, 0, 0, 0}),
      MakeIntrinsic(CameraModel::kFisheye, {0.05, -0.02, 0.01, -0.003}),
      MakeIntrinsic(CameraModel::kSpherical, {}),
  };
  Random random(5);
  for (const Intrinsic& intrinsic : intrinsics) {
    ASSERT_THAT(intrinsic.Validate(), IsOk());
    for (int n = 0; n < 500; ++n) {
      // Up to 45 degrees from the axis (60 for the fisheye), all round for
      // panoramas.
      const double reach = intrinsic.model == CameraModel::kFisheye ? 1.2 : 0.7;
      Vec3 point =
          testing::UniformVec2(random, {-reach, -reach}, {reach, reach})
              .homogeneous();
      if (intrinsic.model == CameraModel::kSpherical) {
        point = {random.Gaussian(), random.Gaussian(), random.Gaussian()};
      }
      const auto bearing = intrinsic.Bearing(intrinsic.Project(point));
      ASSERT_TRUE(bearing) << CameraModelName(intrinsic.model);
      EXPECT_NEAR(bearing->norm(), 1, 1e-14);
      EXPECT_THAT(*bearing, VectorNear(Vec3(point.normalized()), 1e-9))
          << CameraModelName(intrinsic.model);
    }
  }
}

TEST(Intrinsic, NormalizeInvertsProjectionNearTheFoldOfTheDistortion) {
  // x (1 + k1 x^2) is steepest at 0 and flat at x = sqrt(-1 / (3 k1)).
  const Intrinsic intrinsic = MakeIntrinsic(CameraModel::kRadialK1, {-0.25});
  const double fold = std::sqrt(1 / 0.75);
  for (const double share : {0.5, 0.9, 0.97, 0.99}) {
    const Vec3 point(share * fold, 0, 1);
    const auto normalized = intrinsic.Normalize(intrinsic.Project(point));
    ASSERT_TRUE(normalized) << share;
    EXPECT_NEAR(normalized->x(), share * fold, 1e-7) << share;
  }
}

TEST(Intrinsic, NoRayBeyondTheFoldOfTheDistortion) {
  const Intrinsic intrinsic = MakeIntrinsic(CameraModel::kRadialK1, {-0.25});
  const double fold = std::sqrt(1 / 0.75), largest = fold * 2 / 3;
  EXPECT_EQ(intrinsic.Normalize({320 + 500 * (largest + 0.05), 240}),
            std::nullopt);
  EXPECT_EQ(intrinsic.Bearing({320 + 500 * 5.0, 240}), std::nullopt);
}

// Pincushion and then barrel: plain Newton iteration from the pixel would start
// beyond the fold.
TEST(Intrinsic, NormalizeInvertsADistortionThatTurns) {
  const Intrinsic intrinsic =
      MakeIntrinsic(CameraModel::kRadialK3, {0.8, -0.5, 0});
  const double fold = 1.1287;  // 1 + 2.4 r^2 - 2.5 r^4 = 0
  for (double r = 0.05; r < fold; r += 0.05) {
    const auto normalized = intrinsic.Normalize(intrinsic.Project({0, r, 1}));
    ASSERT_TRUE(normalized) << r;
    EXPECT_NEAR(normalized->y(), r, 1e-9) << r;
  }
  EXPECT_EQ(intrinsic.Normalize(intrinsic.Project({0, fold, 1}) + Vec2(0, 1)),
            std::nullopt);
}

// Folds back and rises again: the second branch is not the camera's.
TEST(Intrinsic, NormalizeStaysOnTheFirstBranch) {
  const Intrinsic intrinsic =
      MakeIntrinsic(CameraModel::kRadialK3, {-1.0, 0.35, 0});
  // 1 - 3 s + 1.75 s^2 = 0 first at s = 0.4531, where r_d = 0.4165.
  EXPECT_TRUE(intrinsic.Normalize({320 + 500 * 0.416, 240}));
  EXPECT_EQ(intrinsic.Normalize({320 + 500 * 0.42, 240}), std::nullopt);
}

TEST(Intrinsic, FisheyeSeesNoFurtherThanTheSide) {
  const Intrinsic intrinsic =
      MakeIntrinsic(CameraModel::kFisheye, {0, 0, 0, 0});
  EXPECT_TRUE(intrinsic.Normalize({320 + 500 * 1.5, 240}));
  EXPECT_EQ(intrinsic.Normalize({320 + 500 * 1.6, 240}), std::nullopt);
  EXPECT_THAT(*intrinsic.Normalize({320, 240}), VectorNear(Vec2(0, 0), 1e-15));
}

TEST(Intrinsic, PanoramaHasNoNormalisedPointBehind) {
  const Intrinsic intrinsic = MakeIntrinsic(CameraModel::kSpherical, {});
  EXPECT_EQ(intrinsic.Normalize(intrinsic.Project({0.1, 0.2, -1})),
            std::nullopt);
  EXPECT_THAT(*intrinsic.Normalize(intrinsic.Project({0.1, 0.2, 2})),
              VectorNear(Vec2(0.05, 0.1), 1e-12));
}

TEST(Intrinsic, MeanFocalIsTheGeometricMean) {
  EXPECT_DOUBLE_EQ(MakeIntrinsic(CameraModel::kPinhole, {}).MeanFocalPx(),
                   std::sqrt(500.0 * 510.0));
}

TEST(Intrinsic, ValidateRefuses) {
  for (const CameraModel model : kModels) {
    Intrinsic intrinsic =
        MakeIntrinsic(model, std::vector<double>(DistortionCount(model), 0.0));
    EXPECT_THAT(intrinsic.Validate(), IsOk());
    intrinsic.distortion.push_back(0);
    EXPECT_FALSE(intrinsic.Validate().has_value());
  }
  Intrinsic negative = MakeIntrinsic(CameraModel::kPinhole, {});
  negative.fx_px = -500;
  EXPECT_FALSE(negative.Validate().has_value());
}

TEST(NormalizeFeatures, UndistortsPointsAndSegments) {
  const Intrinsic intrinsic = MakeIntrinsic(CameraModel::kRadialK1, {-0.25});
  const Vec3 a(0.2, 0.1, 1), b(-0.3, 0.4, 1);
  ViewFeatures features;
  features.points_px = {intrinsic.Project(a), {1e5, 0}};
  features.segments = {{intrinsic.Project(a), intrinsic.Project(b), 0.5},
                       {{1e5, 0}, {0, 0}, 0.5},
                       {{3, 4}, {3, 4}, 0.5}};
  const NormalizedFeatures normalized = NormalizeFeatures(features, intrinsic);
  EXPECT_THAT(normalized.points[0], VectorNear(a, 1e-10));
  EXPECT_EQ(normalized.points[1].z(), 0);  // cannot be undistorted
  ASSERT_TRUE(normalized.segments[0].IsValid());
  EXPECT_NEAR(normalized.segments[0].normal.dot(a), 0, 1e-10);
  EXPECT_NEAR(normalized.segments[0].normal.dot(b), 0, 1e-10);
  EXPECT_NEAR(normalized.segments[0].normal.norm(), 1, 1e-14);
  EXPECT_FALSE(normalized.segments[1].IsValid());
  EXPECT_FALSE(normalized.segments[2].IsValid());  // no length
}

}  // namespace
}  // namespace lowlap
