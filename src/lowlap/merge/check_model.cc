#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "lowlap/averaging/rotations/internal/pose_hypotheses.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/merge/internal/agreement.h"
#include "lowlap/merge/internal/rigid_pieces.h"
#include "lowlap/merge/merge_models.h"
#include "lowlap/scale/scale_ratios.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;

// The model's poses by image, with or without the folders of its own.
Result<std::map<std::string, Pose>> PosesByImage(const Scene& model,
                                                 bool with_folders) {
  std::map<std::string, Pose> poses;
  for (const auto& [id, view] : model.views) {
    const Pose* pose = model.FindPose(id);
    if (pose == nullptr) continue;
    const fs::path image = fs::path(view.local_path) / view.filename;
    const std::string name =
        (with_folders ? image : image.filename()).generic_string();
    if (!poses.emplace(name, *pose).second) {
      return MakeError(ErrorCode::kInvalidScene,
                       "two cameras are called '" + name + "'");
    }
  }
  if (poses.empty()) {
    return MakeError(ErrorCode::kInsufficientData,
                     "holds no camera that is placed");
  }
  return poses;
}

Result<GroundTruth> MatchByName(const Scene& measured, const Scene& model,
                                bool with_folders) {
  LOWLAP_ASSIGN_OR_RETURN(const auto poses, PosesByImage(model, with_folders));
  return GroundTruthByName(measured, poses);
}

// What the measured scene has of the pairs that agree, each with the motion
// that does.
Scene SceneOfAgreeing(const Scene& measured,
                      const std::vector<PairAgreement>& pairs) {
  Scene scene;
  std::set<ViewId> views;
  for (const PairAgreement& pair : pairs) {
    if (!pair.Agrees()) continue;
    views.insert({pair.views.first, pair.views.second});
    scene.relative_poses[pair.views] =
        WithHypothesis(measured.relative_poses.at(pair.views), pair.hypothesis);
  }
  for (const ViewId view : views) {
    scene.views.emplace(view, measured.views.at(view));
    const auto features = measured.features.find(view);
    if (features != measured.features.end()) scene.features.insert(*features);
  }
  scene.intrinsics = measured.intrinsics;
  scene.line_tracks = measured.line_tracks;
  return scene;
}

}  // namespace

Result<PartialModel> MatchModel(const Scene& measured, const Scene& model,
                                std::string name) {
  // Programs name images from folders of their own; where these match they
  // tell images of one name apart.
  auto matched = MatchByName(measured, model, true);
  auto by_file = MatchByName(measured, model, false);
  if (by_file && (!matched || by_file->size() > matched->size())) {
    matched = std::move(by_file);
  }
  if (!matched) {
    return MakeError(matched.error().code,
                     matched.error().code == ErrorCode::kInsufficientData
                         ? "none of its placed cameras is an image of the "
                           "measured scene"
                         : matched.error().message,
                     std::move(name));
  }
  return PartialModel{std::move(name), std::move(*matched)};
}

Result<ModelCheck> CheckModel(const Scene& measured, const PartialModel& model,
                              const SolveOptions& options,
                              const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  ModelCheck check;
  check.pairs =
      ComparePairs(measured.relative_poses, model.poses, options.poses);
  const Scene agreeing = SceneOfAgreeing(measured, check.pairs);
  LOWLAP_ASSIGN_OR_RETURN(
      check.measured_ratios,
      EstimateScaleRatios(agreeing, FindTriplets(ViewGraph(agreeing)),
                          *options.scale_estimator, context));
  check.ratios =
      CompareRatios(check.measured_ratios, model.poses, options.poses);
  LOWLAP_ASSIGN_OR_RETURN(
      check.pieces, FindRigidPieces(model.poses, check.pairs, check.ratios,
                                    options.poses.outlier_reach, context));
  std::set<ViewId> confirmed;
  for (const RigidPiece& piece : check.pieces) {
    confirmed.insert(piece.views.begin(), piece.views.end());
  }
  for (const auto& entry : model.poses) {
    if (confirmed.count(entry.first) == 0) {
      check.unconfirmed.push_back(entry.first);
    }
  }
  return check;
}

}  // namespace lowlap
