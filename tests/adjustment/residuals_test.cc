#include <ceres/gradient_checker.h>
#include <ceres/line_manifold.h>
#include <ceres/manifold_test_utils.h>
#include <ceres/product_manifold.h>
#include <ceres/sphere_manifold.h>
#include <gtest/gtest.h>

#include <memory>

#include "lowlap/adjustment/internal/costs/coplanar_costs.h"
#include "lowlap/adjustment/internal/costs/line_reprojection_cost.h"
#include "lowlap/adjustment/internal/costs/plane_costs.h"
#include "lowlap/adjustment/internal/costs/point_reprojection_cost.h"
#include "lowlap/adjustment/internal/costs/relative_pose_prior.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/geometry/internal/rotation.h"
#include "support/random_vectors.h"

namespace lowlap {
namespace {

struct ModelCase {
  CameraModel model;
  std::vector<double> distortion;
};

std::vector<ModelCase> AllModels() {
  return {{CameraModel::kPinhole, {}},
          {CameraModel::kRadialK1, {-0.1}},
          {CameraModel::kRadialK3, {-0.1, 0.03, -0.004}},
          {CameraModel::kBrownT2, {-0.1, 0.03, -0.004, 0.001, -0.002}},
          {CameraModel::kFisheye, {0.02, -0.01, 0.003, -0.0005}},
          {CameraModel::kSpherical, {}}};
}

IntrinsicState MakeIntrinsic(const ModelCase& model_case) {
  IntrinsicState state;
  state.id = 0;
  state.value.model = model_case.model;
  state.value.width_px = 1200;
  state.value.height_px = 800;
  state.value.fx_px = 800;
  state.value.fy_px = 820;
  state.value.principal_point_px = {590, 410};
  state.value.distortion = model_case.distortion;
  state.ParametersFromValue();
  return state;
}

// Four blocks at values where every derivative is far from zero.
struct Blocks {
  Eigen::Quaterniond rotation =
      Eigen::Quaterniond(0.9, 0.1, -0.3, 0.2).normalized();
  Vec3 center{0.4, -0.3, 0.2};
  Vec3 point;
  LineParameters line_a, line_b;

  Blocks() {
    point = center + rotation.conjugate() * Vec3(0.7, -0.4, 3);
    const Vec3 near_point = center + rotation.conjugate() * Vec3(0.2, 0.3, 4);
    line_a << point, Vec3(0.3, 1, 0.4).normalized();
    line_b << near_point, Vec3(1, -0.2, 0.5).normalized();
  }
};

void ExpectGradients(const ceres::CostFunction& cost,
                     const std::vector<const ceres::Manifold*>& manifolds,
                     std::vector<double*> parameters) {
  ceres::NumericDiffOptions options;
  options.ridders_relative_initial_step_size = 1e-3;
  ceres::GradientChecker checker(&cost, &manifolds, options);
  ceres::GradientChecker::ProbeResults results;
  // Compared here by blocks: its own test is relative for every number, and
  // some are zero.
  checker.Probe(parameters.data(), 1e-5, &results);
  ASSERT_TRUE(results.return_value);
  ASSERT_EQ(results.local_jacobians.size(), parameters.size());
  for (std::size_t n = 0; n < parameters.size(); ++n) {
    const double size = results.local_jacobians[n].norm();
    EXPECT_GT(size, 0) << "block " << n;
    EXPECT_LT((results.local_jacobians[n] - results.local_numeric_jacobians[n])
                  .norm(),
              1e-5 * size)
        << "block " << n << "\n"
        << results.error_log;
  }
}

TEST(ResidualsTest, PointGradientsOfEveryCameraModel) {
  const ceres::EigenQuaternionManifold quaternion;
  for (const ModelCase& model_case : AllModels()) {
    SCOPED_TRACE(CameraModelName(model_case.model));
    Blocks blocks;
    IntrinsicState intrinsic = MakeIntrinsic(model_case);
    const PointReprojectionCost fixed(&intrinsic, false, {700, 300});
    ExpectGradients(fixed, {&quaternion, nullptr, nullptr},
                    {blocks.rotation.coeffs().data(), blocks.center.data(),
                     blocks.point.data()});
    if (model_case.model == CameraModel::kSpherical) continue;
    const PointReprojectionCost refined(&intrinsic, true, {700, 300});
    IntrinsicParameters parameters = intrinsic.parameters;
    ExpectGradients(refined, {&quaternion, nullptr, nullptr, nullptr},
                    {blocks.rotation.coeffs().data(), blocks.center.data(),
                     blocks.point.data(), parameters.data()});
  }
}

TEST(ResidualsTest, PointResidualIsTheProjectionOfTheScene) {
  for (const ModelCase& model_case : AllModels()) {
    SCOPED_TRACE(CameraModelName(model_case.model));
    Blocks blocks;
    IntrinsicState intrinsic = MakeIntrinsic(model_case);
    const Vec3 x_cam = blocks.rotation * (blocks.point - blocks.center);
    const Vec2 expected = intrinsic.value.Project(x_cam);
    const double* parameters[] = {blocks.rotation.coeffs().data(),
                                  blocks.center.data(), blocks.point.data(),
                                  intrinsic.parameters.data()};
    for (const bool refined : {false, true}) {
      const PointReprojectionCost cost(&intrinsic, refined, {700, 300});
      Vec2 residual;
      ASSERT_TRUE(cost.Evaluate(parameters, residual.data(), nullptr));
      EXPECT_LT((residual - (expected - Vec2(700, 300))).norm(), 1e-9);
    }
  }
}

TEST(ResidualsTest, PointBehindTheCameraIsAnOutlierWithoutPull) {
  Blocks blocks;
  IntrinsicState intrinsic = MakeIntrinsic(AllModels()[0]);
  blocks.point = blocks.center + blocks.rotation.conjugate() * Vec3(0, 0, -2);
  const PointReprojectionCost cost(&intrinsic, false, {700, 300});
  const double* parameters[] = {blocks.rotation.coeffs().data(),
                                blocks.center.data(), blocks.point.data(),
                                nullptr};
  Vec2 residual;
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> by_point;
  double* jacobians[] = {nullptr, nullptr, by_point.data()};
  ASSERT_TRUE(cost.Evaluate(parameters, residual.data(), jacobians));
  EXPECT_GE(residual.norm(), kBehindCameraErrorPx);
  EXPECT_TRUE(by_point.isZero());
}

TEST(ResidualsTest, PanoramaSeamDoesNotTear) {
  Blocks blocks;
  IntrinsicState intrinsic = MakeIntrinsic(AllModels()[5]);
  // Straight behind: the seam. 1200 px are one turn.
  blocks.point =
      blocks.center + blocks.rotation.conjugate() * Vec3(1e-4, 0, -2);
  const PointReprojectionCost cost(&intrinsic, false, {0.5, 400});
  const double* parameters[] = {blocks.rotation.coeffs().data(),
                                blocks.center.data(), blocks.point.data(),
                                nullptr};
  Vec2 residual;
  ASSERT_TRUE(cost.Evaluate(parameters, residual.data(), nullptr));
  EXPECT_LT(residual.norm(), 1);
}

TEST(ResidualsTest, LineGradientsOfEveryCameraModel) {
  const ceres::EigenQuaternionManifold quaternion;
  const ceres::LineManifold<3> line_manifold;
  const LineSegment segment{{420, 250}, {760, 500}, 0.5};
  for (const ModelCase& model_case : AllModels()) {
    SCOPED_TRACE(CameraModelName(model_case.model));
    Blocks blocks;
    const IntrinsicState intrinsic = MakeIntrinsic(model_case);
    const auto rays = MakeSegmentRays(segment, intrinsic, true);
    ASSERT_TRUE(rays.has_value());
    const LineReprojectionCost fixed(*rays, 0.7, intrinsic, false);
    ExpectGradients(fixed, {&quaternion, nullptr, &line_manifold},
                    {blocks.rotation.coeffs().data(), blocks.center.data(),
                     blocks.line_a.data()});
    if (model_case.model == CameraModel::kSpherical) continue;
    const LineReprojectionCost refined(*rays, 0.7, intrinsic, true);
    IntrinsicParameters parameters = intrinsic.parameters;
    ExpectGradients(refined, {&quaternion, nullptr, &line_manifold, nullptr},
                    {blocks.rotation.coeffs().data(), blocks.center.data(),
                     blocks.line_a.data(), parameters.data()});
  }
}

TEST(ResidualsTest, LineResidualIsTheDistanceInPixels) {
  // fx and fy differ: the distance is that of the pixel line through the
  // projections of two points of the 3D line.
  Blocks blocks;
  const IntrinsicState intrinsic = MakeIntrinsic(AllModels()[0]);
  const LineSegment segment{{420, 250}, {760, 500}, 0.5};
  const auto rays = MakeSegmentRays(segment, intrinsic, false);
  const LineReprojectionCost cost(*rays, 1, intrinsic, false);
  const double* parameters[] = {blocks.rotation.coeffs().data(),
                                blocks.center.data(), blocks.line_a.data(),
                                nullptr};
  Vec2 residual;
  ASSERT_TRUE(cost.Evaluate(parameters, residual.data(), nullptr));
  const auto project = [&](double along) {
    const Vec3 point =
        blocks.line_a.head<3>() + along * blocks.line_a.tail<3>();
    return Vec3(
        intrinsic.value.Project(blocks.rotation * (point - blocks.center))
            .homogeneous());
  };
  const Vec3 image_line = project(0).cross(project(0.5));
  for (int end = 0; end < 2; ++end) {
    const Vec3 pixel =
        (end == 0 ? segment.start_px : segment.end_px).homogeneous();
    EXPECT_NEAR(std::abs(residual(end)),
                std::abs(image_line.dot(pixel)) / image_line.head<2>().norm(),
                1e-9);
  }
}

TEST(ResidualsTest, DistortedLineDistanceIsRawPixelsToFirstOrder) {
  // A segment moved across itself by 1 raw pixel is 1 px away.
  Blocks blocks;
  const IntrinsicState intrinsic = MakeIntrinsic(AllModels()[3]);
  const auto pixel = [&](double along) {
    const Vec3 point =
        blocks.line_a.head<3>() + along * blocks.line_a.tail<3>();
    return intrinsic.value.Project(blocks.rotation * (point - blocks.center));
  };
  const double step = 1e-5;
  for (const double along : {-0.4, 0.5}) {
    const Vec2 tangent = (pixel(along + step) - pixel(along - step));
    const Vec2 across = Vec2(-tangent.y(), tangent.x()).normalized();
    const LineSegment segment{pixel(along) + across, pixel(0.1), 0.5};
    const auto rays = MakeSegmentRays(segment, intrinsic, false);
    const LineReprojectionCost cost(*rays, 1, intrinsic, false);
    const double* parameters[] = {blocks.rotation.coeffs().data(),
                                  blocks.center.data(), blocks.line_a.data(),
                                  nullptr};
    Vec2 residual;
    ASSERT_TRUE(cost.Evaluate(parameters, residual.data(), nullptr));
    EXPECT_NEAR(std::abs(residual(0)), 1, 5e-3);
    EXPECT_NEAR(residual(1), 0, 1e-9);
  }
}

TEST(ResidualsTest, CoplanarGradients) {
  const ceres::LineManifold<3> line_manifold;
  Blocks blocks;
  const std::vector<const ceres::Manifold*> manifolds = {
      nullptr, &line_manifold, &line_manifold};
  const std::vector<double*> parameters = {
      blocks.center.data(), blocks.line_a.data(), blocks.line_b.data()};
  ExpectGradients(CoplanarTransferCost(900), manifolds, parameters);
  ExpectGradients(CoplanarImageDistanceCost(900), manifolds, parameters);
}

TEST(ResidualsTest, PlaneGradients) {
  const ceres::LineManifold<3> line_manifold;
  const ceres::ProductManifold<ceres::SphereManifold<3>,
                               ceres::EuclideanManifold<1>>
      plane_manifold;
  Vec3 point(0.3, -1.2, 4);
  Eigen::Matrix<double, 6, 1> line;
  line << 0.2, 0.5, 3, Vec3(1, -0.4, 0.3).normalized();
  Vec4 plane;
  plane << Vec3(0.2, -0.3, 0.9).normalized(), 0.07;
  const Vec3 anchor(0.1, 0.4, 3.5);
  Vec3 center(0.4, -0.2, 0.3);
  const PlaceOnPlane place(anchor, 40, 3);
  ExpectGradients(PointOnPlaneCost(place), {nullptr, &plane_manifold, nullptr},
                  {point.data(), plane.data(), center.data()});
  ExpectGradients(
      LineOnPlaneCost(place, PlaceOnPlane(anchor, 40, 5), -0.7, 1.1),
      {&line_manifold, &plane_manifold, nullptr},
      {line.data(), plane.data(), center.data()});
}

TEST(ResidualsTest, WhatIsOnThePlaneHasNoDistance) {
  const Vec3 normal = Vec3(0.2, -0.3, 0.9).normalized(), anchor(1, 2, 3);
  Vec4 plane;
  plane << normal, 0.5;
  const Vec3 on_plane = anchor + 0.5 * normal + 2 * normal.unitOrthogonal();
  const Vec3 off_plane = on_plane + 0.25 * normal;
  const Vec3 center = off_plane + Vec3(0, 0, 4);
  const PointOnPlaneCost cost(PlaceOnPlane(anchor, 10, 4));
  double distance;
  const double* blocks[] = {on_plane.data(), plane.data(), center.data()};
  EXPECT_TRUE(cost.Evaluate(blocks, &distance, nullptr));
  EXPECT_NEAR(distance, 0, 1e-12);
  blocks[0] = off_plane.data();
  EXPECT_TRUE(cost.Evaluate(blocks, &distance, nullptr));
  EXPECT_NEAR(distance, 2.5, 1e-12);
  // What shrinks with its camera does not come closer.
  const Vec3 nearer = on_plane + 0.5 * (off_plane - on_plane);
  const Vec3 nearer_center = on_plane + 0.5 * (center - on_plane);
  blocks[0] = nearer.data();
  blocks[2] = nearer_center.data();
  EXPECT_TRUE(cost.Evaluate(blocks, &distance, nullptr));
  EXPECT_NEAR(distance, 2.5, 1e-12);
  blocks[2] = nearer.data();
  EXPECT_FALSE(cost.Evaluate(blocks, &distance, nullptr));
}

TEST(ResidualsTest, RelativePoseGradients) {
  const ceres::EigenQuaternionManifold quaternion;
  Random random(5);
  const auto random_vector = [&] { return testing::GaussianVec3(random); };
  for (int trial = 0; trial < 20; ++trial) {
    Eigen::Quaterniond q1(RotationFromAngleAxis(random_vector()));
    Eigen::Quaterniond q2(RotationFromAngleAxis(random_vector()));
    Vec3 c1 = random_vector(), c2 = random_vector();
    MeasuredRelativePose measured;
    measured.cam2_from_cam1 =
        Eigen::Quaterniond(RotationFromAngleAxis(0.3 * random_vector())) * q2 *
        q1.conjugate();
    measured.tangent_basis = TangentBasis(random_vector().normalized());
    for (double& value : measured.sqrt_information.reshaped()) {
      value = random.Gaussian();
    }
    // Both quaternions of a rotation say the same.
    if (trial % 2 == 1) q1.coeffs() = -q1.coeffs();
    ExpectGradients(
        RelativePoseCost(measured),
        {&quaternion, nullptr, &quaternion, nullptr},
        {q1.coeffs().data(), c1.data(), q2.coeffs().data(), c2.data()});
  }
}

TEST(ResidualsTest, CoplanarResidualsVanishForLinesThatMeet) {
  const Vec3 meeting(0.3, -0.2, 5);
  LineParameters a, b;
  a << meeting + 0.7 * Vec3(1, 0.5, 0.2), Vec3(1, 0.5, 0.2).normalized();
  b << meeting - 1.1 * Vec3(-0.3, 1, 0.1), Vec3(-0.3, 1, 0.1).normalized();
  const Vec3 center(0.1, 0.2, -0.3);
  double transfer;
  const double* const blocks[] = {center.data(), a.data(), b.data()};
  CoplanarTransferCost(900).Evaluate(blocks, &transfer, nullptr);
  EXPECT_NEAR(transfer, 0, 1e-9);
  Vec3 image;
  CoplanarImageDistanceCost(900).Evaluate(blocks, image.data(), nullptr);
  EXPECT_LT(image.norm(), 1e-9);
}

TEST(ResidualsTest, ImageDistanceIsBlindForFrontalPlanesTransferIsNot) {
  // Two lines of planes z = 5 and z = 5.2; the camera looks along their common
  // normal, another stands beside it.
  LineParameters a, b;
  a << 0, 0, 5, 1, 0, 0;
  b << 0, 0, 5.2, 0, 1, 0;
  const Vec3 facing(0, 0, 0), beside(1, 0.5, 0);
  Vec3 image;
  const double* const facing_blocks[] = {facing.data(), a.data(), b.data()};
  CoplanarImageDistanceCost(900).Evaluate(facing_blocks, image.data(), nullptr);
  EXPECT_LT(image.norm(), 1e-9);
  double transfer;
  const double* const beside_blocks[] = {beside.data(), a.data(), b.data()};
  CoplanarTransferCost(900).Evaluate(beside_blocks, &transfer, nullptr);
  EXPECT_GT(std::abs(transfer), 5);
}

TEST(ResidualsTest, LineManifoldKeepsItsInvariants) {
  using namespace ceres;  // the macro of Ceres names its matchers bare
  const ceres::LineManifold<3> manifold;
  Random random(3);
  for (int trial = 0; trial < 20; ++trial) {
    ceres::Vector x(6), delta(4), y(6);
    for (int n = 0; n < 6; ++n) x(n) = random.Gaussian();
    x.tail(3).normalize();
    for (int n = 0; n < 4; ++n) delta(n) = 0.3 * random.Gaussian();
    ASSERT_TRUE(manifold.Plus(x.data(), delta.data(), y.data()));
    EXPECT_NEAR(y.tail(3).norm(), 1, 1e-12);
    EXPECT_THAT_MANIFOLD_INVARIANTS_HOLD(manifold, x, delta, y, 1e-9);
  }
}

}  // namespace
}  // namespace lowlap
