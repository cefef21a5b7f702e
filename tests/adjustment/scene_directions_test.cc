#include "lowlap/adjustment/internal/directions/scene_directions.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <array>
#include <iterator>
#include <set>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/adjustment/internal/costs/direction_cost.h"
#include "lowlap/adjustment/internal/rounds/problem_selection.h"
#include "lowlap/core/internal/random.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/synthetic/synthetic_scene.h"
#include "support/random_vectors.h"

namespace lowlap {
namespace {

using ::testing::IsEmpty;
using ::testing::SizeIs;

// No right angles.
const std::array<Vec3, 3> kDirections = {Vec3(0.02, 0.01, 1).normalized(),
                                         Vec3(1, 0.1, 0).normalized(),
                                         Vec3(0.3, 1, 0.05).normalized()};

SyntheticScene Room() {
  SyntheticOptions options;
  options.num_views = 6;
  options.pairs = "chain";
  options.noise_px = 1;
  return *Simulate(options);
}

double LineAngleDeg(const Vec3& a, const Vec3& b) {
  return DegFromRad(std::min(AngleBetween(a, b), AngleBetween(a, -b)));
}

// Sights of the three directions from every camera of the scene.
std::vector<DirectionSight> Sights(const CameraSet& cameras, double stated_deg,
                                   double noise_deg) {
  Random random(3);
  std::vector<DirectionSight> sights;
  for (int pose = 0; pose < static_cast<int>(cameras.poses.size()); ++pose) {
    for (const Vec3& direction : kDirections) {
      DirectionSight sight;
      sight.pose = pose;
      const Vec3 turn =
          RadFromDeg(noise_deg) * testing::GaussianVec3(random, 1);
      sight.direction = RotationFromAngleAxis(turn) *
                        (cameras.poses[pose].cam_from_world * direction);
      if (pose % 2 == 1) sight.direction = -sight.direction;
      sight.covariance =
          std::pow(RadFromDeg(stated_deg), 2) *
          (Mat3::Identity() - sight.direction * sight.direction.transpose());
      sight.log10_nfa = -10 - pose;
      sights.push_back(sight);
    }
  }
  return sights;
}

// Segments of lines along the three directions, which no view matches.
void AddParallelLines(const SyntheticScene& truth, Scene* scene) {
  Random random(5);
  for (auto& [view, features] : scene->features) {
    const Intrinsic& intrinsic = *scene->FindIntrinsic(view);
    const RigidTransform cam_from_world =
        truth.true_poses.at(view).CamFromWorld();
    features.segments.clear();
    for (const Vec3& direction : kDirections) {
      int count = 0;
      for (int n = 0; n < 2000 && count < 25; ++n) {
        const Vec3 in_camera =
            testing::UniformVec3(random, {-3, -2, 3}, {3, 2, 6});
        std::array<Vec2, 2> ends;
        bool is_inside = true;
        for (int end = 0; end < 2; ++end) {
          const Vec3 x = in_camera + (end == 0 ? -0.5 : 0.5) *
                                         (cam_from_world.rotation * direction);
          ends[end] =
              Vec2(intrinsic.fx_px * x.x(), intrinsic.fy_px * x.y()) / x.z() +
              intrinsic.principal_point_px;
          is_inside = is_inside && x.z() > 1 && ends[end].minCoeff() > 0 &&
                      ends[end].x() < intrinsic.width_px &&
                      ends[end].y() < intrinsic.height_px;
          ends[end] += testing::GaussianVec2(random, 0.3);
        }
        if (!is_inside) continue;
        features.segments.push_back({ends[0], ends[1], 0.3});
        ++count;
      }
    }
  }
}

TEST(DirectionCost, HasTheDerivativesOfItsResidual) {
  const Vec3 sight = Vec3(0.3, -0.2, 1).normalized();
  Mat3 covariance = Vec3(2e-4, 1e-4, 1e-4).asDiagonal();
  const DirectionCost cost(sight, covariance);
  Eigen::Quaterniond rotation(0.9, 0.1, -0.3, 0.2);
  rotation.normalize();
  Vec3 direction = rotation.conjugate() * Vec3(0.32, -0.17, 1).normalized();
  const double* const blocks[] = {rotation.coeffs().data(), direction.data()};
  Vec2 residual;
  Eigen::Matrix<double, 2, 4, Eigen::RowMajor> by_rotation;
  Eigen::Matrix<double, 2, 3, Eigen::RowMajor> by_direction;
  double* jacobians[] = {by_rotation.data(), by_direction.data()};
  ASSERT_TRUE(cost.Evaluate(blocks, residual.data(), jacobians));
  constexpr double kStep = 1e-6;
  const auto slope = [&](double* value) -> Vec2 {
    Vec2 high, low;
    *value += kStep;
    cost.Evaluate(blocks, high.data(), nullptr);
    *value -= 2 * kStep;
    cost.Evaluate(blocks, low.data(), nullptr);
    *value += kStep;
    return (high - low) / (2 * kStep);
  };
  for (int k = 0; k < 4; ++k) {
    EXPECT_LT((slope(rotation.coeffs().data() + k) - by_rotation.col(k)).norm(),
              1e-5);
  }
  for (int k = 0; k < 3; ++k) {
    EXPECT_LT((slope(direction.data() + k) - by_direction.col(k)).norm(), 1e-5);
  }
}

TEST(DirectionCost, CountsDeviationsAndNoSign) {
  const double stddev = 0.01;
  const DirectionCost cost(Vec3::UnitZ(), stddev * stddev * Mat3::Identity());
  const Eigen::Quaterniond rotation = Eigen::Quaterniond::Identity();
  for (const double sign : {1.0, -1.0}) {
    const Vec3 direction = sign * Vec3(0.02, 0, 1).normalized();
    const double* const blocks[] = {rotation.coeffs().data(), direction.data()};
    Vec2 residual;
    ASSERT_TRUE(cost.Evaluate(blocks, residual.data(), nullptr));
    EXPECT_NEAR(residual.norm(), 2, 1e-3);
  }
}

TEST(GroupDirections, JoinsWhatAllCamerasSee) {
  const CameraSet cameras(TrueSolution(Room()));
  auto sights = Sights(cameras, 0.2, 0.2);
  // One that a single camera sees.
  sights.push_back(sights.front());
  sights.back().direction = Vec3(1, 1, 1).normalized();
  const auto directions = GroupDirections(sights, cameras);
  ASSERT_THAT(directions, SizeIs(3));
  for (const SceneDirection& direction : directions) {
    EXPECT_THAT(direction.sights, SizeIs(6));
    std::set<int> poses;
    double nearest = 180;
    for (const DirectionSight& sight : direction.sights) {
      poses.insert(sight.pose);
    }
    for (const Vec3& truth : kDirections) {
      nearest = std::min(nearest, LineAngleDeg(direction.direction, truth));
    }
    EXPECT_THAT(poses, SizeIs(6));
    EXPECT_LT(nearest, 0.3);
  }
}

// Where lines are less parallel than stated, they count for less; where they
// are more parallel, they keep what they state.
TEST(GroupDirections, CovariancesFollowWhatTheDirectionsDeviate) {
  const CameraSet cameras(TrueSolution(Room()));
  const auto variance_with = [&](double noise_deg) {
    const auto directions =
        GroupDirections(Sights(cameras, 0.1, noise_deg), cameras);
    EXPECT_THAT(directions, SizeIs(3));
    return directions.front().sights.front().covariance.trace() /
           (2 * std::pow(RadFromDeg(0.1), 2));
  };
  EXPECT_NEAR(variance_with(0.02), 1, 1e-9);
  EXPECT_GT(variance_with(0.4), 6);
  EXPECT_LT(variance_with(0.4), 30);
}

TEST(FindDirectionSights, FindsTheDirectionsInEveryView) {
  const SyntheticScene room = Room();
  Scene scene = TrueSolution(room);
  AddParallelLines(room, &scene);
  const CameraSet cameras(scene);
  const auto sights = FindDirectionSights(scene, cameras, {});
  ASSERT_TRUE(sights);
  EXPECT_GE(sights->size(), 12u);
  for (const DirectionSight& sight : *sights) {
    double nearest = 180;
    for (const Vec3& truth : kDirections) {
      nearest = std::min(
          nearest,
          LineAngleDeg(sight.direction,
                       cameras.poses[sight.pose].cam_from_world * truth));
    }
    EXPECT_LT(nearest, 2);
    EXPECT_LT(sight.log10_nfa, 0);
  }
  scene.features.clear();
  const auto none = FindDirectionSights(scene, CameraSet(scene), {});
  ASSERT_TRUE(none);
  EXPECT_THAT(*none, IsEmpty());
}

// They are in the frame of the component while that is solved.
TEST(EnterComponentFrames, TurnsTheDirectionsOfAComponent) {
  const SyntheticScene room = Room();
  const Scene scene = TrueSolution(room);
  CameraSet cameras(scene);
  StructureState state;
  state.points = LoadPoints(scene, cameras);
  state.directions = GroupDirections(Sights(cameras, 0.1, 0), cameras);
  ASSERT_THAT(state.directions, SizeIs(3));
  const std::vector<Component> components = FindComponents(
      cameras, state, SelectForSolve(cameras, state, AdjustmentOptions()));
  ASSERT_THAT(components, SizeIs(1));
  EXPECT_THAT(components[0].directions, ::testing::ElementsAre(0, 1, 2));
  const auto largest_angle_deg = [&] {
    double largest = 0;
    for (const SceneDirection& direction : state.directions) {
      for (const DirectionSight& sight : direction.sights) {
        const Vec3 in_camera =
            cameras.poses[sight.pose].cam_from_world * direction.direction;
        largest = std::max(largest, LineAngleDeg(in_camera, sight.direction));
      }
    }
    return largest;
  };
  const Vec3 in_world = state.directions[0].direction;
  EXPECT_LT(largest_angle_deg(), 1e-6);
  const auto references = EnterComponentFrames(components, &cameras, &state);
  EXPECT_LT(largest_angle_deg(), 1e-6);
  EXPECT_GT(LineAngleDeg(state.directions[0].direction, in_world), 1);
  LeaveComponentFrames(components, references, &cameras, &state);
  EXPECT_LT(LineAngleDeg(state.directions[0].direction, in_world), 1e-6);
}

// A chain of few noisy points drifts; what is parallel does not.
TEST(AdjustScene, DirectionsTakeTheDriftOutOfRotations) {
  const SyntheticScene room = Room();
  Scene scene = TrueSolution(room);
  AddParallelLines(room, &scene);
  scene.line_structure.clear();
  scene.line_tracks.clear();
  scene.coplanar_pairs.clear();
  scene.point_tracks.clear();
  std::map<ViewId, int> count;
  for (auto landmark = scene.structure.begin();
       landmark != scene.structure.end();) {
    auto& observations = landmark->second.observations;
    observations.resize(2);
    const bool is_kept =
        observations[1].view.value() == observations[0].view.value() + 1 &&
        ++count[observations[0].view] <= 12;
    landmark = is_kept ? std::next(landmark) : scene.structure.erase(landmark);
  }
  scene.relative_poses.clear();
  scene.scale_ratios.clear();
  const auto mean_error_deg = [&](bool directions) {
    AdjustmentOptions options;
    options.use_coplanar = false;
    options.use_directions = directions;
    Scene adjusted = scene;
    const auto summary = AdjustScene(&adjusted, options, {});
    EXPECT_TRUE(summary) << summary.error().ToString();
    EXPECT_EQ(summary->directions > 0, directions);
    return EvaluatePoses(adjusted, room.true_poses).rotation_deg.mean;
  };
  EXPECT_LT(mean_error_deg(true), 0.6 * mean_error_deg(false));
}

}  // namespace
}  // namespace lowlap
