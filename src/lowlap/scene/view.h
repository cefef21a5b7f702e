#pragma once

#include <optional>
#include <string>

#include "lowlap/core/ids.h"
#include "lowlap/geometry/rigid_transform.h"
#include "lowlap/geometry/types.h"

namespace lowlap {

/// A measured camera centre (GPS), as OpenMVG's `view_priors` stores it.
struct CenterPrior {
  Vec3 weight = Vec3::Ones();
  Vec3 center_in_world = Vec3::Zero();

  friend bool operator==(const CenterPrior& a, const CenterPrior& b) {
    return a.weight == b.weight && a.center_in_world == b.center_in_world;
  }
};

/// One photograph. Its path is root_path / local_path / filename; several views
/// may share an intrinsic or a pose. intrinsic_id is kInvalidId when nothing is
/// known of the camera.
struct View {
  std::string local_path;
  std::string filename;
  int width_px = 0;
  int height_px = 0;
  IntrinsicId intrinsic_id = kInvalidId;
  PoseId pose_id = kInvalidId;
  std::optional<CenterPrior> center_prior;

  /// local_path / filename, with slashes: what tells photographs of one file
  /// name apart.
  std::string PathBelowRoot() const;

  friend bool operator==(const View& a, const View& b) {
    return a.local_path == b.local_path && a.filename == b.filename &&
           a.width_px == b.width_px && a.height_px == b.height_px &&
           a.intrinsic_id == b.intrinsic_id && a.pose_id == b.pose_id &&
           a.center_prior == b.center_prior;
  }
};

/// An absolute pose as files store it: x_cam = rotation (X - center).
struct Pose {
  Mat3 rotation = Mat3::Identity();  // camera from world
  Vec3 center = Vec3::Zero();        // in world
  /// World units squared: what a similarity between all centres and the true
  /// ones leaves of the error of this one. Absent if unknown.
  std::optional<Mat3> center_covariance = std::nullopt;

  RigidTransform CamFromWorld() const {
    return RigidTransform::FromRotationAndCenter(rotation, center);
  }

  friend bool operator==(const Pose& a, const Pose& b) {
    return a.rotation == b.rotation && a.center == b.center &&
           a.center_covariance == b.center_covariance;
  }
};

}  // namespace lowlap
