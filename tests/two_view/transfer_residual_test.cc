#include "lowlap/two_view/internal/planes/transfer_residual.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>

#include "lowlap/two_view/internal/search/refine_relative_pose.h"
#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::kPlaneNormal;
using testing::MakeTwoViewScene;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

TwoViewScene PlanarScene(double noise_px, std::uint64_t seed) {
  TwoViewSceneOptions options;
  options.planar = true;
  options.noise_px = noise_px;
  return MakeTwoViewScene(options, seed);
}

// Shapes of errors that differ from match to match.
void ShapeErrors(PointPairs* pairs) {
  for (int i = 0; i < pairs->size(); ++i) {
    Mat2 covariance;
    covariance << 4 + i % 3, 1.5, 1.5, 1;
    pairs->covariance1.push_back(covariance);
    pairs->covariance2.push_back(covariance.inverse());
  }
}

TEST(TransferResidual, VanishesOnThePlane) {
  const TwoViewScene scene = PlanarScene(0, 1);
  PointPairs pairs = scene.Pairs();
  ShapeErrors(&pairs);
  const TransferResidual residual(scene.cam2_from_cam1, kPlaneNormal, pairs);
  for (int i = 0; i < pairs.size(); ++i) {
    ASSERT_TRUE(residual(i));
    EXPECT_LT(residual(i)->norm(), 1e-9);
    EXPECT_LT(std::abs(residual.Along(i)), 1e-9);
  }
}

TEST(TransferResidual, IsAcrossAndAlongTheEpipolarLine) {
  const TwoViewScene scene = PlanarScene(0.01, 2);
  PointPairs pairs = scene.Pairs();
  ShapeErrors(&pairs);
  const TransferResidual residual(scene.cam2_from_cam1, kPlaneNormal, pairs);
  const SampsonResidual across(scene.cam2_from_cam1, pairs);
  for (int i = 0; i < pairs.size(); ++i) {
    const double norm = residual(i)->norm();
    EXPECT_NEAR(std::hypot(across(i), residual.Along(i)), norm, 1e-3 * norm);
  }
}

TEST(TransferResidual, HasTheStatedDerivatives) {
  const TwoViewScene scene = PlanarScene(0, 3);
  PointPairs pairs = scene.Pairs();
  ShapeErrors(&pairs);
  constexpr double kStep = 1e-6;
  const TransferResidual residual(scene.cam2_from_cam1, kPlaneNormal, pairs);
  for (int i = 0; i < 10; ++i) {
    TransferResidual::Jacobian jacobian;
    residual(i, &jacobian);
    Vec3 by_normal;
    residual.Along(i, &by_normal);
    for (int k = 0; k < 8; ++k) {
      const auto moved = [&](double step) {
        Vec5 change = Vec5::Zero();
        Vec3 normal = kPlaneNormal;
        (k < 5 ? change[k] : normal[k - 5]) += step;
        return TransferResidual(MovedPose(scene.cam2_from_cam1, change), normal,
                                pairs);
      };
      const Vec2 slope = (*moved(kStep)(i) - *moved(-kStep)(i)) / (2 * kStep);
      EXPECT_LT((slope - jacobian.col(k)).norm(), 1e-4 * slope.norm() + 1e-4);
      if (k < 5) continue;
      EXPECT_NEAR(
          (moved(kStep).Along(i) - moved(-kStep).Along(i)) / (2 * kStep),
          by_normal[k - 5], 1e-4 * by_normal.norm());
    }
  }
}

TEST(TransferResidual, NoPlaneBehindTheCamera) {
  const TwoViewScene scene = PlanarScene(0, 4);
  const PointPairs pairs = scene.Pairs();
  const TransferResidual residual(
      {scene.cam2_from_cam1.rotation, -Vec3::UnitZ()}, 10 * Vec3::UnitZ(),
      pairs);
  EXPECT_FALSE(residual(0));
  EXPECT_EQ(residual.Along(0), std::numeric_limits<double>::infinity());
}

}  // namespace
}  // namespace lowlap
