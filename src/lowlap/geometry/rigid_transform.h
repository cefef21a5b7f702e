#pragma once

#include "lowlap/geometry/types.h"

namespace lowlap {

/// x_target = rotation x_source + translation. Variables are named
/// `target_from_source`, so that compositions read like fractions:
/// cam2_from_world = cam2_from_cam1 * cam1_from_world.
struct RigidTransform {
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();

  static RigidTransform FromRotationAndCenter(const Mat3& rotation,
                                              const Vec3& center) {
    return {rotation, -(rotation * center)};
  }

  /// The origin of the target frame in source coordinates: -R^T t. For
  /// cam_from_world this is the camera centre.
  Vec3 Center() const { return -(rotation.transpose() * translation); }

  Vec3 operator*(const Vec3& x) const { return rotation * x + translation; }

  RigidTransform operator*(const RigidTransform& other) const {
    return {rotation * other.rotation,
            rotation * other.translation + translation};
  }

  RigidTransform Inverse() const {
    return {rotation.transpose(), -(rotation.transpose() * translation)};
  }

  /// [R | t], 3x4.
  Mat34 Matrix() const { return (Mat34() << rotation, translation).finished(); }
};

}  // namespace lowlap
