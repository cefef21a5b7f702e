#include "lowlap/averaging/scene_poses.h"

#include <algorithm>
#include <set>
#include <utility>

#include "lowlap/averaging/centers/internal/weighed_centers.h"
#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/reliability/internal/find_reliability_warnings.h"
#include "lowlap/averaging/reliability/internal/hanging_views.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

// What was said of the rotations, of placed views.
void AddRotationDoubts(const SceneRotations& rotations,
                       const std::set<ViewId>& placed, PoseSummary* summary) {
  const auto is_placed = [&](ViewId view) { return placed.count(view) > 0; };
  summary->matches = rotations.matches;
  summary->loops = rotations.loops;
  for (ContestedLink link : rotations.contested) {
    if (!is_placed(link.edge.first) || !is_placed(link.edge.second)) continue;
    link.views.erase(
        std::remove_if(link.views.begin(), link.views.end(),
                       [&](ViewId view) { return !is_placed(view); }),
        link.views.end());
    summary->contested.push_back(std::move(link));
  }
  for (const ViewPair& edge : rotations.unchecked) {
    if (is_placed(edge.first) && is_placed(edge.second)) {
      summary->unchecked.push_back(edge);
    }
  }
  summary->median_rotation_residual_deg =
      DegFromRad(rotations.median_residual_rad);
}

// What became of views, edges and ratios.
PoseSummary CountPlaced(const Scene& scene, const SceneCenters& centers,
                        const std::set<ViewId>& placed) {
  PoseSummary summary;
  summary.num_views = static_cast<int>(scene.views.size());
  summary.num_placed = static_cast<int>(placed.size());
  summary.components.resize(
      static_cast<std::size_t>(centers.solution.num_components));
  for (std::size_t n = 0; n < centers.problem.views.size(); ++n) {
    const int component = centers.solution.component[n];
    if (component < 0) continue;
    summary.components[component].push_back(centers.problem.views[n]);
  }
  for (const auto& entry : scene.views) {
    if (placed.count(entry.first) == 0) summary.unplaced.push_back(entry.first);
  }
  summary.outlier_edges = centers.outlier_edges;
  summary.kept_outliers = centers.kept_outliers;
  summary.left_out_ratios = centers.left_out_ratios;
  for (const ViewTriplet& views : centers.weak_ratios) {
    if (placed.count(views.first) > 0 && placed.count(views.middle) > 0 &&
        placed.count(views.last) > 0) {
      summary.weak_ratios.push_back(views);
    }
  }
  summary.num_edges = static_cast<int>(centers.problem.edges.size());
  summary.num_ratios = static_cast<int>(centers.problem.ratios.size() -
                                        centers.left_out_ratios.size());
  return summary;
}

PoseSummary Summarize(const Scene& scene, const SceneRotations& rotations,
                      WeighedCenters weighed, const PoseOptions& options) {
  const SceneCenters& centers = weighed.centers;
  const std::set<ViewId> placed = centers.PlacedViews();
  PoseSummary summary = CountPlaced(scene, centers, placed);
  AddRotationDoubts(rotations, placed, &summary);
  summary.agreement = std::make_shared<const SolutionAgreement>(
      FindAgreement(scene, centers.problem, centers.solution, rotations.matches,
                    {options.outlier_reach, centers.sigma_rad,
                     RadFromDeg(options.least_false_deg)}));
  summary.reliability_warnings = FindReliabilityWarnings(
      scene, *summary.agreement, {}, &summary.firm_evidence);
  summary.contests = std::move(weighed.contests);
  WarnOfHangingViews(&summary);
  return summary;
}

}  // namespace

Status PoseOptions::Validate() const {
  if (!(outlier_reach > 0)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "poses: the outlier reach must be positive");
  }
  if (!(least_false_deg >= 0)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "poses: least_false_deg must not be negative");
  }
  return rotation.Validate();
}

Result<SceneRotations> AverageSceneRotations(const Scene& scene,
                                             const PoseOptions& options,
                                             const RunContext& context,
                                             ThirdViewVerdicts third_views) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  RotationAveragingOptions rotation = options.rotation;
  rotation.seed = context.seed;
  return AverageSceneRotations(scene, rotation, options.outlier_reach,
                               RadFromDeg(options.least_false_deg), context,
                               std::move(third_views));
}

Result<PoseSummary> SolveScenePoses(Scene* scene, const PoseOptions& options,
                                    const RunContext& context) {
  LOWLAP_ASSIGN_OR_RETURN(const auto rotations,
                          AverageSceneRotations(*scene, options, context));
  return SolveScenePoses(scene, rotations, options, context);
}

Result<PoseSummary> SolveScenePoses(Scene* scene,
                                    const SceneRotations& rotations,
                                    const PoseOptions& options,
                                    const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  LOWLAP_ASSIGN_OR_RETURN(
      WeighedCenters weighed,
      SolveWeighedCenters(*scene, rotations, options, context));
  SetPoses(weighed.centers.problem, weighed.centers.solution, scene);
  return Summarize(*scene, rotations, std::move(weighed), options);
}

void SetPoses(const TranslationProblem& problem,
              const TranslationSolution& solution, Scene* scene) {
  double total = 0;
  int count = 0;
  for (const DirectionEdge& edge : problem.edges) {
    if (solution.component[edge.first] != 0 ||
        solution.component[edge.second] != 0) {
      continue;
    }
    total += (solution.center_in_world[edge.second] -
              solution.center_in_world[edge.first])
                 .norm();
    ++count;
  }
  const double scale = total > 0 ? count / total : 1.0;
  scene->poses.clear();
  bool first = true;
  Mat3 old_world_from_world = Mat3::Identity();
  Vec3 origin = Vec3::Zero();
  for (std::size_t n = 0; n < problem.views.size(); ++n) {
    if (solution.component[n] != 0) continue;
    if (first) {
      old_world_from_world = problem.cam_from_world[n].transpose();
      origin = solution.center_in_world[n];
      first = false;
    }
    Pose pose;
    pose.rotation =
        NearestRotation(problem.cam_from_world[n] * old_world_from_world);
    pose.center = scale * (old_world_from_world.transpose() *
                           (solution.center_in_world[n] - origin));
    scene->poses[scene->views.at(problem.views[n]).pose_id] = pose;
  }
}

}  // namespace lowlap
