#include "third_party_adapters/openmvg/engine/translation_step.h"

#include <algorithm>

#include "lowlap/averaging/reliability/internal/pose_warnings.h"
#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/pipeline/internal/given_rotations.h"
#include "lowlap/pipeline/internal/measure/matched_points.h"
#include "lowlap/scene/validation.h"

namespace lowlap::openmvg {
namespace {

Status InvalidInput(const std::string& message) {
  return MakeError(ErrorCode::kInvalidScene, message);
}

Status CheckMatches(const TranslationStepInput& input) {
  const auto count = [&](ViewId view) -> std::size_t {
    const auto features = input.scene.features.find(view);
    return features == input.scene.features.end()
               ? 0
               : features->second.points_px.size();
  };
  for (const auto& [pair, matches] : input.matches) {
    if (!(pair.first < pair.second) ||
        input.scene.views.count(pair.first) == 0 ||
        input.scene.views.count(pair.second) == 0) {
      return InvalidInput("matches of the pair " + PairName(pair) +
                          ": its views are unknown, equal or out of order");
    }
    const std::size_t first = count(pair.first), second = count(pair.second);
    for (const FeatureMatch& match : matches) {
      if (match.first < first && match.second < second) continue;
      return InvalidInput("matches of the pair " + PairName(pair) +
                          ": a feature does not exist");
    }
  }
  return {};
}

Status Check(const TranslationStepInput& input,
             const TranslationStepOptions& options) {
  if (input.error) return tl::unexpected<Error>(*input.error);
  for (const Status& valid :
       {ValidateScene(input.scene), options.solve.Validate(),
        options.relative_poses.Validate(), CheckMatches(input)}) {
    if (!valid) return valid;
  }
  const auto is_rotation = [](const Mat3& matrix) {
    return RotationDefect(matrix) <= kUnitTolerance;
  };
  for (const auto& [pose, rotation] : input.rotations) {
    if (!is_rotation(rotation)) {
      return InvalidInput("the global rotation of pose " +
                          std::to_string(pose.value()) + " is none");
    }
  }
  for (const auto& [poses, transform] : input.relative_poses) {
    if (!is_rotation(transform.rotation) ||
        !transform.translation.allFinite() ||
        !(transform.translation.norm() > 0)) {
      return InvalidInput("the relative pose of poses " +
                          std::to_string(poses.first.value()) + " and " +
                          std::to_string(poses.second.value()) +
                          " has no rotation or no direction");
    }
  }
  return {};
}

// The pairs that are asked for, with the relative poses that are known.
MatchedPoints SelectMatches(TranslationStepInput* input) {
  MatchedPoints points;
  for (auto& [pair, matches] : input->matches) {
    const PosePair poses{input->scene.views.at(pair.first).pose_id,
                         input->scene.views.at(pair.second).pose_id};
    const PosePair turned{poses.second, poses.first};
    if (input->pairs && input->pairs->count(poses) == 0 &&
        input->pairs->count(turned) == 0) {
      continue;
    }
    const auto known = input->relative_poses.find(poses);
    const auto known_turned = input->relative_poses.find(turned);
    if (known != input->relative_poses.end()) {
      points.cam2_from_cam1[pair] = known->second;
    } else if (known_turned != input->relative_poses.end()) {
      points.cam2_from_cam1[pair] = known_turned->second.Inverse();
    }
    points.matches[pair] = std::move(matches);
  }
  return points;
}

Result<PoseSummary> Solve(const TranslationStepInput& input,
                          const TranslationStepOptions& options,
                          const RunContext& context, Scene* scene) {
  SolveResult result;
  if (input.rotations.empty()) {
    LOWLAP_ASSIGN_OR_RETURN(result,
                            SolveScene(scene, options.solve, context, nullptr));
    return std::move(result.poses);
  }
  std::map<ViewId, Mat3> cam_from_world;
  for (const auto& [id, view] : scene->views) {
    const auto rotation = input.rotations.find(view.pose_id);
    if (rotation != input.rotations.end()) {
      cam_from_world.emplace(id, rotation->second);
    }
  }
  LOWLAP_ASSIGN_OR_RETURN(
      result.poses, SolveGivenRotations(cam_from_world, options.solve, context,
                                        nullptr, scene));
  LOWLAP_RETURN_IF_ERROR(
      FinishSolution(scene, options.solve, context, nullptr, &result));
  return std::move(result.poses);
}

}  // namespace

Result<TranslationStepResult> RunTranslationStep(
    TranslationStepInput input, const TranslationStepOptions& options,
    const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(Check(input, options));
  const MatchedPoints points = SelectMatches(&input);
  Scene scene = std::move(input.scene);
  LOWLAP_ASSIGN_OR_RETURN(
      const auto pairs,
      RelateMatchedPoints(points,
                          options.use_photographs ? PhotographUse::kLinesIfThere
                                                  : PhotographUse::kNone,
                          options.relative_poses, {}, context, nullptr,
                          &scene));
  if (scene.relative_poses.empty()) {
    return MakeError(ErrorCode::kInsufficientData, ExplainNoPose(pairs));
  }
  LOWLAP_ASSIGN_OR_RETURN(const auto summary,
                          Solve(input, options, context, &scene));

  TranslationStepResult result;
  result.poses = scene.poses;
  result.unplaced = summary.unplaced;
  result.warnings = PoseWarnings(summary, scene);
  const std::vector<ViewPair> outliers = PairsOf(summary.outlier_edges);
  for (const auto& [pair, pose] : scene.relative_poses) {
    if (scene.FindPose(pair.first) != nullptr &&
        scene.FindPose(pair.second) != nullptr &&
        std::find(outliers.begin(), outliers.end(), pair) == outliers.end()) {
      result.inliers[pair] = pose.point_inliers;
    }
  }
  return result;
}

}  // namespace lowlap::openmvg
