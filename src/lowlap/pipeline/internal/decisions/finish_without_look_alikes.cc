#include "lowlap/pipeline/internal/decisions/finish_without_look_alikes.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/averaging/reliability/internal/look_alikes.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/believed_evidence.h"
#include "lowlap/pipeline/internal/decisions/compose_again.h"
#include "lowlap/pipeline/internal/decisions/decide_by_structure.h"
#include "lowlap/pipeline/internal/decisions/settle_contests.h"

namespace lowlap {
namespace {

// What solving changes of a scene, but for relative poses.
struct SolvedParts {
  std::map<IntrinsicId, Intrinsic> intrinsics, given_intrinsics;
  std::map<PoseId, Pose> poses;
  std::vector<ScaleRatio> scale_ratios;
  std::map<PointTrackId, Landmark> structure;
  std::map<LineTrackId, LineLandmark> line_structure;
  std::vector<CoplanarPair> coplanar_pairs;

  explicit SolvedParts(const Scene& scene)
      : intrinsics(scene.intrinsics),
        given_intrinsics(scene.given_intrinsics),
        poses(scene.poses),
        scale_ratios(scene.scale_ratios),
        structure(scene.structure),
        line_structure(scene.line_structure),
        coplanar_pairs(scene.coplanar_pairs) {}

  void PutBack(Scene* scene) const {
    scene->intrinsics = intrinsics;
    scene->given_intrinsics = given_intrinsics;
    scene->poses = poses;
    scene->scale_ratios = scale_ratios;
    scene->structure = structure;
    scene->line_structure = line_structure;
    scene->coplanar_pairs = coplanar_pairs;
  }
};

// The relative poses among whose motions the structure may decide.
std::vector<RelativePose> OpenPoses(const Scene& scene) {
  std::vector<RelativePose> open;
  for (const auto& entry : scene.relative_poses) {
    if (!entry.second.alternatives.empty()) open.push_back(entry.second);
  }
  return open;
}

// `known`: look-alikes of an earlier solution, or nullptr.
Result<SolveResult> Finish(ComposedSolution composed,
                           const std::shared_ptr<const LookAlikes>& known,
                           const SolveOptions& options,
                           const RunContext& context, StageLog* stages,
                           Scene* scene) {
  SolveResult result;
  result.motions = std::move(composed.start.motions);
  result.reconsidered = std::move(composed.start.reconsidered);
  result.ratios = composed.ratios;
  result.poses = std::move(composed.poses);
  LOWLAP_RETURN_IF_ERROR(DecideHypothesesByStructure(
      composed.start.rotations, options, context, stages, scene, &result));
  result.poses.look_alikes = known;
  LOWLAP_RETURN_IF_ERROR(
      FinishSolution(scene, options, context, stages, &result));
  return result;
}

// What the scene is solved from again.
struct Restart {
  SolvedParts parts;
  std::vector<RelativePose> open_poses;
  SolveStart start;
};

// `left_out`, sorted, have no part in it, as if they had been compared in vain;
// the last of them are of `known`.
Result<SolveResult> SolveWithout(const std::vector<ViewPair>& left_out,
                                 const std::shared_ptr<const LookAlikes>& known,
                                 const Restart& restart,
                                 const SolveOptions& options,
                                 const RunContext& context, StageLog* stages,
                                 Scene* scene) {
  restart.parts.PutBack(scene);
  for (const RelativePose& pose : restart.open_poses) {
    scene->relative_poses.at(pose.views) = pose;
  }
  const std::vector<ViewPair> unrelated = scene->unrelated_pairs;
  std::vector<ScaleRatio> ratios;
  const auto solve = [&]() -> Result<SolveResult> {
    const BelievedEvidence believed(left_out, scene);
    scene->unrelated_pairs.clear();
    std::set_union(unrelated.begin(), unrelated.end(), left_out.begin(),
                   left_out.end(), std::back_inserter(scene->unrelated_pairs));
    MatchVerdicts matches = restart.start.rotations.matches;
    matches.refuted.erase(
        std::remove_if(matches.refuted.begin(), matches.refuted.end(),
                       [&](const ViewPair& views) {
                         return std::binary_search(left_out.begin(),
                                                   left_out.end(), views);
                       }),
        matches.refuted.end());
    LOWLAP_ASSIGN_OR_RETURN(
        auto composed,
        ComposeAgain(matches, restart.start.rotations.third_views, options,
                     context, stages, scene));
    LOWLAP_RETURN_IF_ERROR(
        SettleContests(options, context, stages, scene, &composed));
    composed.start.motions = restart.start.motions;
    composed.start.reconsidered = restart.start.reconsidered;
    auto result =
        Finish(std::move(composed), known, options, context, stages, scene);
    ratios = scene->scale_ratios;
    return result;
  };
  auto result = solve();
  scene->unrelated_pairs = unrelated;
  scene->scale_ratios = std::move(ratios);
  if (!result) return result;
  std::vector<OutlierEdge>& outliers = result->poses.outlier_edges;
  for (const ViewPair& views : left_out) {
    outliers.push_back({views, OutlierReason::kLookAlike, 0});
  }
  std::sort(outliers.begin(), outliers.end(),
            [](const OutlierEdge& a, const OutlierEdge& b) {
              return a.views < b.views;
            });
  return result;
}

// Fewer pairs are of groups that see different things at one place, and only
// doubtful views are lost.
bool IsBetter(const SolveResult& again, const SolveResult& first) {
  const LookAlikes& found = *first.poses.look_alikes;
  const auto is_lost_without_doubt = [&](ViewId view) {
    const std::vector<ViewId>& before = first.poses.unplaced;
    return std::find(before.begin(), before.end(), view) == before.end() &&
           !std::binary_search(found.doubtful.begin(), found.doubtful.end(),
                               view);
  };
  return again.adjustment.has_value() == first.adjustment.has_value() &&
         again.poses.look_alikes->different.size() < found.different.size() &&
         std::none_of(again.poses.unplaced.begin(), again.poses.unplaced.end(),
                      is_lost_without_doubt);
}

}  // namespace

Result<SolveResult> FinishWithoutLookAlikes(ComposedSolution composed,
                                            const SolveOptions& options,
                                            const RunContext& context,
                                            StageLog* stages, Scene* scene) {
  const Restart restart = {SolvedParts(*scene), OpenPoses(*scene),
                           composed.start};
  LOWLAP_ASSIGN_OR_RETURN(auto result, Finish(std::move(composed), nullptr,
                                              options, context, stages, scene));
  std::vector<ViewPair> left_out;
  while (!result.poses.look_alikes->false_poses.empty()) {
    const std::vector<ViewPair>& found = result.poses.look_alikes->false_poses;
    left_out.insert(left_out.end(), found.begin(), found.end());
    std::sort(left_out.begin(), left_out.end());
    const std::string poses =
        std::to_string(left_out.size()) +
        " relative poses that join places that look alike";
    context.Log(LogLevel::kInfo, "solving again without " + poses);
    const SolvedParts solved(*scene);
    const std::map<ViewPair, RelativePose> relative_poses =
        scene->relative_poses;
    auto again = SolveWithout(left_out, result.poses.look_alikes, restart,
                              options, context, stages, scene);
    if (!again && again.error().code == ErrorCode::kCancelled) return again;
    if (!again || !IsBetter(*again, result)) {
      context.Log(LogLevel::kInfo, "no better without " + poses);
      solved.PutBack(scene);
      scene->relative_poses = relative_poses;
      return result;
    }
    result = std::move(*again);
  }
  return result;
}

}  // namespace lowlap
