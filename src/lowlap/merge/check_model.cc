#include <algorithm>
#include <filesystem>
#include <set>
#include <utility>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/merge/internal/agreement.h"
#include "lowlap/merge/internal/rigid_pieces.h"
#include "lowlap/merge/merge_models.h"
#include "lowlap/pipeline/internal/scene_reduction.h"
#include "lowlap/scale/scale_ratios.h"
#include "lowlap/scene/view_graph.h"

namespace lowlap {
namespace {

namespace fs = std::filesystem;

// The model's poses by image, with or without the folders of its own.
Result<std::map<std::string, Pose>> PosesByImage(const Scene& model,
                                                 bool with_folders) {
  std::map<std::string, Pose> poses;
  bool has_nameless = false;
  for (const auto& [id, view] : model.views) {
    const Pose* pose = model.FindPose(id);
    if (pose == nullptr) continue;
    if (view.filename.empty()) {
      has_nameless = true;
      continue;
    }
    const std::string path = view.PathBelowRoot();
    const std::string name =
        with_folders ? path : fs::path(path).filename().generic_string();
    if (!poses.emplace(name, *pose).second) {
      return MakeError(ErrorCode::kInvalidScene,
                       "two cameras are called '" + name + "'");
    }
  }
  if (poses.empty() && has_nameless) {
    return MakeError(ErrorCode::kInvalidScene,
                     "its cameras have no file names, which would tell their "
                     "photographs; not every format holds names");
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
  auto matched = GroundTruthByName(measured, poses);
  if (!matched && matched.error().code == ErrorCode::kInsufficientData) {
    matched.error().message =
        "none of its placed cameras is an image of the measured scene";
  }
  return matched;
}

}  // namespace

Result<PartialModel> MatchModel(const Scene& measured, const Scene& model,
                                std::string name, const RunContext& context) {
  auto matched = MatchByName(measured, model, true);
  // Names of which two are one only without folders are an error of their own.
  if (!matched) matched = MatchByName(measured, model, false);
  if (!matched) {
    matched.error().file = std::move(name);
    return tl::unexpected<Error>(matched.error());
  }
  const std::size_t num_placed = GroundTruthFromScene(model).size();
  if (matched->size() < num_placed) {
    context.Log(LogLevel::kWarning,
                name + ": " + std::to_string(num_placed - matched->size()) +
                    " of its cameras are no images of the measured scene");
  }
  return PartialModel{Printable(name), std::move(*matched)};
}

bool RigidPiece::Holds(ViewId a, ViewId b) const {
  return std::binary_search(pairs.begin(), pairs.end(), OrderedPair(a, b));
}

Result<ModelCheck> CheckModel(const Scene& measured, const PartialModel& model,
                              const SolveOptions& options,
                              const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  ModelCheck check;
  check.pairs =
      ComparePairs(measured.relative_poses, model.poses, options.poses);
  std::map<ViewPair, std::size_t> hypotheses;
  for (const PairAgreement& pair : check.pairs) {
    if (pair.Agrees()) hypotheses.emplace(pair.views, pair.hypothesis);
  }
  const Scene agreeing = SceneOfPairs(measured, hypotheses);
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

Result<std::vector<ModelCheck>> CheckModels(
    const Scene& measured, const std::vector<PartialModel>& models,
    const SolveOptions& options, const RunContext& context, StageLog* stages) {
  std::vector<ModelCheck> checks;
  for (const PartialModel& model : models) {
    const StageLog::Scope scope(stages, "model check");
    LOWLAP_ASSIGN_OR_RETURN(auto check,
                            CheckModel(measured, model, options, context));
    checks.push_back(std::move(check));
  }
  return checks;
}

}  // namespace lowlap
