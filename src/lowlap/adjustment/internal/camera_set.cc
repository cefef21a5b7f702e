#include "lowlap/adjustment/internal/camera_set.h"

#include <algorithm>

namespace lowlap {

void IntrinsicState::ParametersFromValue() {
  parameters.fill(0);
  parameters[0] = value.fx_px;
  parameters[1] = value.fy_px;
  parameters[2] = value.principal_point_px.x();
  parameters[3] = value.principal_point_px.y();
  std::copy(value.distortion.begin(), value.distortion.end(),
            parameters.begin() + 4);
}

void IntrinsicState::ValueFromParameters() {
  value.fx_px = parameters[0];
  value.fy_px = parameters[1];
  value.principal_point_px = {parameters[2], parameters[3]};
  std::copy_n(parameters.begin() + 4, value.distortion.size(),
              value.distortion.begin());
}

CameraSet::CameraSet(const Scene& scene) {
  std::map<PoseId, int> pose_index;
  std::map<IntrinsicId, int> intrinsic_index;
  for (const auto& [id, view] : scene.views) {
    const Pose* pose = scene.FindPose(id);
    const Intrinsic* intrinsic = scene.FindIntrinsic(id);
    if (pose == nullptr || intrinsic == nullptr) continue;
    const auto [pose_at, new_pose] =
        pose_index.emplace(view.pose_id, static_cast<int>(poses.size()));
    if (new_pose) {
      poses.push_back({view.pose_id,
                       Eigen::Quaterniond(pose->rotation).normalized(),
                       pose->center});
    }
    const auto [intrinsic_at, new_intrinsic] = intrinsic_index.emplace(
        view.intrinsic_id, static_cast<int>(intrinsics.size()));
    if (new_intrinsic) {
      const auto given = scene.given_intrinsics.find(view.intrinsic_id);
      intrinsics.push_back({view.intrinsic_id,
                            *intrinsic,
                            given != scene.given_intrinsics.end()
                                ? given->second.principal_point_px
                                : intrinsic->principal_point_px,
                            {}});
      intrinsics.back().ParametersFromValue();
    }
    view_index.emplace(id, static_cast<int>(views.size()));
    views.push_back({id, pose_at->second, intrinsic_at->second});
  }
}

int CameraSet::Find(ViewId view) const {
  const auto found = view_index.find(view);
  return found == view_index.end() ? -1 : found->second;
}

double CameraSet::Mean(double (Intrinsic::*size)() const) const {
  double sum = 0;
  for (const IntrinsicState& state : intrinsics) sum += (state.value.*size)();
  return intrinsics.empty() ? 1 : sum / static_cast<double>(intrinsics.size());
}

void CameraSet::WriteTo(Scene* scene) const {
  for (const PoseState& state : poses) {
    Pose& pose = scene->poses.at(state.id);
    pose.rotation = state.cam_from_world.toRotationMatrix();
    pose.center = state.center;
  }
  for (const IntrinsicState& state : intrinsics) {
    Intrinsic& value = scene->intrinsics.at(state.id);
    if (value == state.value) continue;
    scene->given_intrinsics.emplace(state.id, value);
    value = state.value;
  }
}

}  // namespace lowlap
