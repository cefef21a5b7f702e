#pragma once

#include <string>

#include "lowlap/core/internal/random.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/geometry/similarity.h"

namespace lowlap {

inline Vec3 RandomVector(Random& random) {
  const double x = random.Gaussian(), y = random.Gaussian();
  return {x, y, random.Gaussian()};
}

inline Pose RandomPose(Random& random) {
  Pose pose;
  pose.rotation = RotationFromAngleAxis(RandomVector(random));
  pose.center = 3.0 * RandomVector(random);
  return pose;
}

/// Views 0, 2, 4, ... with pose ids of their own (view + 100) and random poses.
inline Scene RandomScene(int num_views, std::uint64_t seed) {
  Random random(seed);
  Scene scene;
  for (int n = 0; n < num_views; ++n) {
    const auto id = static_cast<std::uint32_t>(2 * n);
    View view;
    view.filename = "image" + std::to_string(id) + ".jpg";
    view.pose_id = id + 100;
    scene.views[id] = view;
    scene.poses[view.pose_id] = RandomPose(random);
  }
  return scene;
}

/// The same cameras seen from a world that `to_from_scene` maps to.
inline void Transform(const Similarity& to_from_scene, Scene& scene) {
  for (auto& [id, pose] : scene.poses) {
    pose.rotation = pose.rotation * to_from_scene.rotation.transpose();
    pose.center = to_from_scene * pose.center;
  }
}

/// The relative pose of two views of a solved scene.
inline RelativePose TrueRelativePose(const Scene& scene, ViewId first,
                                     ViewId second) {
  const RigidTransform transform =
      scene.FindPose(second)->CamFromWorld() *
      scene.FindPose(first)->CamFromWorld().Inverse();
  RelativePose relative;
  relative.views = {first, second};
  relative.rotation = transform.rotation;
  relative.direction = transform.translation.normalized();
  return relative;
}

}  // namespace lowlap
