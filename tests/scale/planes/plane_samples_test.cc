#include "lowlap/scale/internal/planes/plane_samples.h"

#include <gtest/gtest.h>

#include <set>
#include <vector>

#include "scale/synthetic_planes.h"

namespace lowlap {
namespace {

using testing::MakeSyntheticPlanes;
using testing::SyntheticPlanes;
using testing::SyntheticPlanesOptions;

TEST(DepthSamples, AreExactWithoutNoise) {
  SyntheticPlanesOptions options;
  options.num_lines_per_wall = 10;
  const SyntheticPlanes scene = MakeSyntheticPlanes(options, 1);
  const std::vector<DepthSample> samples = DepthSamples(
      scene.geometry.cami_from_camj, 900, 900, scene.points_ij, scene.lines_ij);
  std::set<bool> kinds;
  for (const DepthSample& sample : samples) {
    const double truth = scene.InverseDepthIj(sample.ray);
    EXPECT_NEAR(sample.inverse_depth, truth, 1e-6 * truth);
    kinds.insert(sample.is_line);
  }
  EXPECT_EQ(kinds.size(), 2u);
  EXPECT_GT(samples.size(), 100u);
}

TEST(DepthSamples, SpeedIsTheDerivativeOfTheTransfer) {
  const SyntheticPlanes scene = MakeSyntheticPlanes({}, 2);
  const RigidTransform& i_from_j = scene.geometry.cami_from_camj;
  const std::vector<DepthSample> samples =
      DepthSamples(i_from_j, 900, 900, scene.points_ij, {});
  ASSERT_FALSE(samples.empty());
  for (const DepthSample& sample : samples) {
    const auto transfer = [&](double rho) {
      const Vec3 y =
          i_from_j.rotation * sample.ray + rho * i_from_j.translation;
      return Vec2(900 * y.head<2>() / y.z());
    };
    constexpr double kStep = 1e-6;
    const double speed = (transfer(sample.inverse_depth + kStep) -
                          transfer(sample.inverse_depth - kStep))
                             .norm() /
                         (2 * kStep);
    EXPECT_NEAR(sample.speed_px, speed, 1e-4 * speed);
  }
}

TEST(DepthSamples, LeavesOutPointsBehindTheCamerasAndAtTheEpipole) {
  const RigidTransform n_from_j{Mat3::Identity(), Vec3(0, 0, 1)};
  const Vec3 ray(0.2, 0.1, 1);
  // A point that comes nearer when the camera goes back is behind it.
  EXPECT_TRUE(
      DepthSamples(n_from_j, 900, 900, {{0, ray, Vec3(0.4, 0.2, 1)}}, {})
          .empty());
  EXPECT_TRUE(
      DepthSamples(n_from_j, 900, 900, {{0, Vec3::UnitZ(), Vec3::UnitZ()}}, {})
          .empty());
  EXPECT_EQ(DepthSamples(n_from_j, 900, 900, {{0, ray, Vec3(0.1, 0.05, 1)}}, {})
                .size(),
            1u);
}

TEST(DepthSamples, LeavesOutLinesInAnEpipolarPlane) {
  const RigidTransform n_from_j{Mat3::Identity(), Vec3(1, 0, 0)};
  const NormalizedSegment along =
      testing::MakeSegment(Vec3(-0.2, 0.1, 1), Vec3(0.2, 0.1, 1));
  const MatchedLine line{0, {along, 0.5}, {along, 0.5}};
  EXPECT_TRUE(DepthSamples(n_from_j, 900, 900, {}, {line}).empty());
}

}  // namespace
}  // namespace lowlap
