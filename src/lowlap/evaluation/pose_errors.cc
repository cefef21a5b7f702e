#include "lowlap/evaluation/pose_errors.h"

#include <cstddef>

#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

/// A camera that both the solution and the truth have.
struct CommonCamera {
  const Pose* solved;
  const Pose* truth;
};

/// The alignment of the centres, or an error that says why there is none.
Result<Similarity> AlignCentres(const std::vector<CommonCamera>& cameras) {
  if (cameras.size() == 2) {
    return MakeError(ErrorCode::kInsufficientData,
                     "2 cameras are common to solution and truth: a similarity "
                     "fits their centres exactly, only rotations are compared");
  }
  std::vector<Vec3> solved, truth;
  for (const CommonCamera& camera : cameras) {
    solved.push_back(camera.solved->center);
    truth.push_back(camera.truth->center);
  }
  return AlignPoints(solved, truth);
}

}  // namespace

const char* EvaluationScopeName(EvaluationScope scope) {
  switch (scope) {
    case EvaluationScope::kNothing:
      return "nothing";
    case EvaluationScope::kRotationsOnly:
      return "rotations_only";
    case EvaluationScope::kFull:
      return "full";
  }
  return "unknown";
}

PoseEvaluation EvaluatePoses(const Scene& scene, const GroundTruth& truth) {
  return EvaluatePoses(scene.views, scene.poses, truth);
}

PoseEvaluation EvaluatePoses(const std::map<ViewId, View>& views,
                             const std::map<PoseId, Pose>& poses,
                             const GroundTruth& truth) {
  PoseEvaluation result;
  std::vector<CommonCamera> cameras;
  for (const auto& [id, view] : views) {
    const auto true_pose = truth.find(id);
    if (true_pose == truth.end()) {
      if (poses.count(view.pose_id) > 0) {
        result.without_truth.push_back(view.PathBelowRoot());
      }
      continue;
    }
    ++result.num_total;
    if (const auto solved = poses.find(view.pose_id); solved != poses.end()) {
      cameras.push_back({&solved->second, &true_pose->second});
      ViewPoseError error;
      error.view = id;
      error.name = view.PathBelowRoot();
      result.views.push_back(std::move(error));
    } else {
      result.unsolved.push_back(view.PathBelowRoot());
    }
  }
  result.num_solved = static_cast<int>(cameras.size());
  if (cameras.size() < 2) {
    result.note =
        "fewer than 2 cameras are common to solution and truth: "
        "nothing can be compared";
    return result;
  }

  Mat3 correlation = Mat3::Zero();
  for (const CommonCamera& camera : cameras) {
    correlation += camera.truth->rotation.transpose() * camera.solved->rotation;
  }
  const Mat3 truth_from_solution = NearestRotation(correlation);
  std::vector<double> rotation_errors;
  for (std::size_t n = 0; n < cameras.size(); ++n) {
    const double error_deg = DegFromRad(
        RotationAngleBetween(cameras[n].solved->rotation,
                             cameras[n].truth->rotation * truth_from_solution));
    result.views[n].rotation_error_deg = error_deg;
    rotation_errors.push_back(error_deg);
  }
  result.rotation_deg = Summarize(std::move(rotation_errors));

  const Result<Similarity> alignment = AlignCentres(cameras);
  if (!alignment) {
    result.scope = EvaluationScope::kRotationsOnly;
    result.note = alignment.error().message;
    return result;
  }
  result.scope = EvaluationScope::kFull;
  result.truth_from_solution = *alignment;
  result.frame_disagreement_deg = DegFromRad(
      RotationAngleBetween(alignment->rotation, truth_from_solution));
  std::vector<double> position_errors;
  for (std::size_t n = 0; n < cameras.size(); ++n) {
    const double error =
        (cameras[n].truth->center - *alignment * cameras[n].solved->center)
            .norm();
    result.views[n].position_error = error;
    position_errors.push_back(error);
  }
  result.position = Summarize(std::move(position_errors));
  return result;
}

}  // namespace lowlap
