#include <set>
#include <string>

#include "lowlap/core/internal/format.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scene/internal/validation_parts.h"

namespace lowlap {
namespace {

Status ValidateView(const Scene& scene, ViewId id, const View& view) {
  const auto invalid = [&](std::string message, const char* member) {
    return Invalid(std::move(message), ItemPlace("views", id.value()) + member);
  };
  if (id == kInvalidId) return invalid("this id is reserved", "");
  if (!IsUtf8(view.local_path)) return invalid("not UTF-8", ".local_path");
  if (!IsUtf8(view.filename)) return invalid("not UTF-8", ".filename");
  if (view.width_px < 0) return invalid("must not be negative", ".width");
  if (view.height_px < 0) return invalid("must not be negative", ".height");
  if (view.intrinsic_id != kInvalidId &&
      scene.intrinsics.count(view.intrinsic_id) == 0) {
    return invalid(
        "there is no intrinsic " + std::to_string(view.intrinsic_id.value()),
        ".id_intrinsic");
  }
  if (view.center_prior) {
    if (!view.center_prior->weight.allFinite()) {
      return invalid("must be finite", ".center_weight");
    }
    if (!view.center_prior->center_in_world.allFinite()) {
      return invalid("must be finite", ".center");
    }
  }
  return {};
}

}  // namespace

Status ValidateCameras(const Scene& scene, const ViewTable&) {
  if (!IsUtf8(scene.root_path)) return Invalid("not UTF-8", "$.root_path");
  std::set<IntrinsicId> used_intrinsics;
  std::set<PoseId> used_poses;
  for (const auto& [id, view] : scene.views) {
    if (Status status = ValidateView(scene, id, view); !status) return status;
    used_intrinsics.insert(view.intrinsic_id);
    used_poses.insert(view.pose_id);
  }
  for (const auto& [id, intrinsic] : scene.intrinsics) {
    const std::string place = ItemPlace("intrinsics", id.value());
    if (id == kInvalidId) return Invalid("this id is reserved", place);
    if (used_intrinsics.count(id) == 0) {
      return Invalid("no view uses this intrinsic", place);
    }
    if (const Status status = intrinsic.Validate(); !status) {
      return Invalid(status.error().message, place);
    }
  }
  for (const auto& [id, given] : scene.given_intrinsics) {
    const std::string place =
        OwnItemPlace("given_intrinsics", "id", std::to_string(id.value()));
    if (scene.intrinsics.count(id) == 0) {
      return Invalid("there is no intrinsic " + std::to_string(id.value()),
                     place);
    }
    if (const Status status = given.Validate(); !status) {
      return Invalid(status.error().message, place);
    }
  }
  for (const auto& [id, pose] : scene.poses) {
    const std::string place = ItemPlace("extrinsics", id.value());
    if (id == kInvalidId) return Invalid("this id is reserved", place);
    if (used_poses.count(id) == 0) {
      return Invalid("no view uses this pose", place);
    }
    if (!(RotationDefect(pose.rotation) <= kUnitTolerance)) {
      return Invalid("is not a rotation matrix", place + ".rotation");
    }
    if (!pose.center.allFinite()) {
      return Invalid("must be finite", place + ".center");
    }
    if (pose.center_covariance && !IsCovariance(*pose.center_covariance)) {
      return Invalid(kNoCovariance, OwnItemPlace("center_covariances", "id",
                                                 std::to_string(id.value())) +
                                        ".covariance");
    }
  }
  return {};
}

}  // namespace lowlap
