#pragma once

#include <Eigen/Geometry>
#include <array>
#include <limits>
#include <map>
#include <vector>

#include "lowlap/robust/internal/a_contrario.h"
#include "lowlap/scene/scene.h"

namespace lowlap {

/// The error of what no camera can see.
inline constexpr double kInfinity = std::numeric_limits<double>::infinity();

/// fx, fy, ppx, ppy, then the distortion coefficients.
inline constexpr int kMaxIntrinsicParameters = 9;
using IntrinsicParameters = std::array<double, kMaxIntrinsicParameters>;

struct PoseState {
  PoseId id = kInvalidId;
  Eigen::Quaterniond cam_from_world = Eigen::Quaterniond::Identity();
  Vec3 center = Vec3::Zero();

  RigidTransform CamFromWorld() const {
    return RigidTransform::FromRotationAndCenter(
        cam_from_world.toRotationMatrix(), center);
  }
};

struct IntrinsicState {
  IntrinsicId id = kInvalidId;
  Intrinsic value;
  Vec2 given_principal_point_px = Vec2::Zero();  // as given
  IntrinsicParameters parameters{};              // the solver's copy of `value`

  int ParameterCount() const {
    return 4 + static_cast<int>(value.distortion.size());
  }
  void ParametersFromValue();
  void ValueFromParameters();
};

struct CameraView {
  ViewId id = kInvalidId;
  int pose = -1;
  int intrinsic = -1;
};

/// The views that have a pose and an intrinsic, addressed by index; several
/// may share either.
struct CameraSet {
  std::vector<PoseState> poses;
  std::vector<IntrinsicState> intrinsics;
  std::vector<CameraView> views;
  std::map<ViewId, int> view_index;

  explicit CameraSet(const Scene& scene);

  /// -1 for views without a pose or an intrinsic.
  int Find(ViewId view) const;
  const PoseState& PoseOf(int view) const { return poses[views[view].pose]; }
  const IntrinsicState& IntrinsicOf(int view) const {
    return intrinsics[views[view].intrinsic];
  }

  /// Mean over the intrinsics, for the background laws; 1 without any.
  double Mean(double (Intrinsic::*size)() const) const;
  BackgroundLaw PointToPoint() const {
    return BackgroundLaw::PointToPoint(Mean(&Intrinsic::ImageArea));
  }
  BackgroundLaw PointToLine() const {
    return BackgroundLaw::PointToLine(Mean(&Intrinsic::ImageArea),
                                      Mean(&Intrinsic::ImageDiagonal));
  }

  /// Poses and intrinsics back into the scene, which keeps the given ones of
  /// intrinsics that moved.
  void WriteTo(Scene* scene) const;
};

}  // namespace lowlap
