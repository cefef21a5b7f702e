#include "lowlap/pipeline/internal/given_rotations.h"

#include <utility>
#include <vector>

#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/rotations/scene_rotations.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

double ResidualRad(const RelativePose& pose,
                   const std::map<ViewId, Mat3>& cam_from_world) {
  return RotationAngleBetween(
      pose.rotation, cam_from_world.at(pose.views.second) *
                         cam_from_world.at(pose.views.first).transpose());
}

// The rotations, with the relative poses that contradict them as outliers.
SceneRotations Compare(const std::map<ViewId, Mat3>& cam_from_world,
                       const PoseOptions& options, const Scene& scene) {
  SceneRotations rotations;
  rotations.cam_from_world = cam_from_world;
  std::vector<double> residuals_rad;
  for (const auto& entry : scene.relative_poses) {
    residuals_rad.push_back(ResidualRad(entry.second, cam_from_world));
  }
  rotations.median_residual_rad = Median(residuals_rad);
  const double sigma_rad = ResidualStddev<3>(std::move(residuals_rad));
  const ErrorLimits limits = LimitsOf(options);
  for (const auto& [views, pose] : scene.relative_poses) {
    const double residual_rad = ResidualRad(pose, cam_from_world);
    if (residual_rad > limits.RotationRad(sigma_rad, RotationStddev(pose))) {
      rotations.outliers.push_back(
          {views, OutlierReason::kRotation, DegFromRad(residual_rad)});
    }
  }
  return rotations;
}

}  // namespace

Result<PoseSummary> SolveGivenRotations(
    const std::map<ViewId, Mat3>& cam_from_world, const SolveOptions& options,
    const RunContext& context, StageLog* stages, Scene* scene) {
  SolveStart start;
  start.rotations = Compare(cam_from_world, options.poses, *scene);
  const auto ratios =
      EstimateBelievedRatios(scene, start, options, context, stages);
  if (!ratios) return tl::unexpected<Error>(ratios.error());
  const StageLog::Scope scope(stages, "poses");
  auto summary =
      SolveScenePoses(scene, start.rotations, options.poses, context);
  if (!summary) return summary;
  // Poses come in the frame of the first placed view.
  std::map<PoseId, Mat3> given;
  Mat3 given_from_world = Mat3::Identity();
  for (const auto& [view, rotation] : cam_from_world) {
    if (scene->FindPose(view) == nullptr) continue;
    if (given.empty()) given_from_world = rotation.transpose();
    given.emplace(scene->views.at(view).pose_id, rotation);
  }
  for (const auto& [id, rotation] : given) {
    Pose& pose = scene->poses.at(id);
    pose = {rotation, given_from_world * pose.center};
  }
  return summary;
}

}  // namespace lowlap
