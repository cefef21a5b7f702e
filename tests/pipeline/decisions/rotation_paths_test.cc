#include "lowlap/pipeline/internal/decisions/rotation_paths.h"

#include <gtest/gtest.h>

#include <cmath>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

constexpr double kFloorRad = 1e-3;

Scene Ring() {
  SyntheticOptions options;
  options.num_views = 12;
  options.pairs = "cycle";
  options.noise_px = 0.2;
  options.pose_noise_factor = 1;
  options.seed = 4;
  return Simulate(options)->scene;
}

// The pair gets another motion, turned against its own by the angle.
void Open(const ViewPair& views, double angle_rad, Scene* scene) {
  RelativePose& pose = scene->relative_poses.at(views);
  pose.alternatives.push_back(
      {RotationFromAngleAxis(angle_rad * Vec3::UnitY()) * pose.rotation,
       pose.direction, pose.log10_nfa, pose.covariance});
}

TEST(RotationPaths, TheOtherWayRoundTheRing) {
  const Scene scene = Ring();
  const auto prior = RotationPaths(scene, kFloorRad).Find({0, 1});
  ASSERT_TRUE(prior);
  EXPECT_EQ(prior->path.size(), 11u);
  EXPECT_LT(RotationAngleBetween(prior->rotation.cam2_from_cam1,
                                 scene.relative_poses.at({0, 1}).rotation),
            RadFromDeg(1));
}

// Which of its motions is right decides where the path leads.
TEST(RotationPaths, AnOpenMotionIsAsUncertainAsItsMotionsAreApart) {
  Scene scene = Ring();
  const double known =
      RotationPaths(scene, kFloorRad).Find({0, 1})->rotation.stddev_rad;
  Open({3, 4}, 0.05, &scene);
  const auto prior = RotationPaths(scene, kFloorRad).Find({0, 1});
  ASSERT_TRUE(prior);
  EXPECT_NEAR(prior->rotation.stddev_rad, std::hypot(known, 0.05), 1e-9);
}

TEST(RotationPaths, NoneThroughMotionsFarApart) {
  Scene scene = Ring();
  Open({3, 4}, 0.12, &scene);
  EXPECT_FALSE(RotationPaths(scene, kFloorRad).Find({0, 1}));
}

// They may differ in direction alone.
TEST(RotationPaths, MotionsOfOneRotationAreNoLessCertain) {
  Scene scene = Ring();
  const double known =
      RotationPaths(scene, kFloorRad).Find({0, 1})->rotation.stddev_rad;
  Open({3, 4}, 0, &scene);
  RelativePose& open = scene.relative_poses.at({3, 4});
  open.alternatives.back().direction = -open.direction;
  const auto prior = RotationPaths(scene, kFloorRad).Find({0, 1});
  ASSERT_TRUE(prior);
  EXPECT_NEAR(prior->rotation.stddev_rad, known, 1e-9);
}

}  // namespace
}  // namespace lowlap
