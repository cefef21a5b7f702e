#include "lowlap/pipeline/internal/given_rotations.h"

#include <utility>
#include <vector>

#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"
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

// Settles the alternatives of the scene's relative poses, drops those of views
// without a rotation, and finds those that contradict the rotations.
SceneRotations Compare(const std::map<ViewId, Mat3>& cam_from_world,
                       const PoseOptions& options, Scene* scene) {
  SceneRotations rotations;
  rotations.cam_from_world = cam_from_world;
  std::vector<double> residuals_rad;
  auto& poses = scene->relative_poses;
  for (auto entry = poses.begin(); entry != poses.end();) {
    RelativePose& pose = entry->second;
    if (cam_from_world.count(pose.views.first) == 0 ||
        cam_from_world.count(pose.views.second) == 0) {
      entry = poses.erase(entry);
      continue;
    }
    RelativePose closest = WithHypothesis(pose, 0);
    for (std::size_t n = 1; n < NumHypotheses(pose); ++n) {
      RelativePose other = WithHypothesis(pose, n);
      if (ResidualRad(other, cam_from_world) <
          ResidualRad(closest, cam_from_world)) {
        closest = std::move(other);
      }
    }
    pose = std::move(closest);
    residuals_rad.push_back(ResidualRad(pose, cam_from_world));
    ++entry;
  }
  rotations.median_residual_rad = Median(residuals_rad);
  const double sigma_rad = ResidualStddev<3>(std::move(residuals_rad));
  const ErrorLimits limits = LimitsOf(options);
  for (const auto& [views, pose] : poses) {
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
  start.rotations = Compare(cam_from_world, options.poses, scene);
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
