#include "lowlap/averaging/scene_poses.h"

#include <algorithm>
#include <set>
#include <utility>

#include "lowlap/averaging/internal/contests.h"
#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/internal/hanging_views.h"
#include "lowlap/averaging/internal/reliability_warnings.h"
#include "lowlap/averaging/internal/scene_centers.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

std::set<ViewId> PlacedViews(const SceneCenters& centers) {
  std::set<ViewId> placed;
  for (std::size_t n = 0; n < centers.problem.views.size(); ++n) {
    if (centers.solution.component[n] == 0) {
      placed.insert(centers.problem.views[n]);
    }
  }
  return placed;
}

// Whether a relative pose that disagrees says that something is wrong: not if
// its matches do not bear it out.
bool Contradicts(const OutlierEdge& edge, const MatchVerdicts& matches) {
  return edge.IsFalse() &&
         std::find(matches.untold.begin(), matches.untold.end(), edge.views) ==
             matches.untold.end();
}

// Those of the relative poses of placed views; what is contested already is
// named.
std::vector<Contest> ContestsAmong(const Scene& scene,
                                   const SceneRotations& rotations,
                                   const TranslationProblem& problem,
                                   const std::set<ViewId>& placed,
                                   const PoseSummary& summary) {
  const auto evidence = [&](const ViewPair& views) {
    return 1 + std::max(0.0, -scene.relative_poses.at(views).log10_nfa);
  };
  EvidenceOfPairs in_use;
  RejectedPoses rejected;
  const auto is_placed = [&](const ViewPair& views) {
    return placed.count(views.first) > 0 && placed.count(views.second) > 0;
  };
  for (const DirectionEdge& edge : problem.edges) {
    const ViewPair views{problem.views[edge.first], problem.views[edge.second]};
    if (is_placed(views)) in_use[views] = evidence(views);
  }
  for (const OutlierEdge& edge : summary.kept_outliers) {
    in_use.erase(edge.views);
  }
  for (const auto* edges : {&summary.kept_outliers, &summary.outlier_edges}) {
    for (const OutlierEdge& edge : *edges) {
      if (is_placed(edge.views) && Contradicts(edge, summary.matches)) {
        const RelativePose& pose = scene.relative_poses.at(edge.views);
        const Mat3 turn =
            rotations.cam_from_world.at(edge.views.second).transpose() *
            pose.rotation * rotations.cam_from_world.at(edge.views.first);
        rejected[edge.views] = {evidence(edge.views), turn,
                                RotationStddev(pose)};
      }
    }
  }
  EvidenceOfRatios ratios;
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    if (ratio.verdict == RatioVerdict::kMeaningful) {
      ratios[ratio.views] = 1 - ratio.log10_nfa;
    }
  }
  std::vector<Contest> contests = FindContests(in_use, ratios, rejected);
  contests.erase(std::remove_if(contests.begin(), contests.end(),
                                [&](const Contest& contest) {
                                  return std::any_of(
                                      summary.contested.begin(),
                                      summary.contested.end(),
                                      [&](const ContestedLink& link) {
                                        return contest.links ==
                                               std::vector<ViewPair>{link.edge};
                                      });
                                }),
                 contests.end());
  return contests;
}

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
                      const SceneCenters& centers, const PoseOptions& options) {
  const std::set<ViewId> placed = PlacedViews(centers);
  PoseSummary summary = CountPlaced(scene, centers, placed);
  AddRotationDoubts(rotations, placed, &summary);
  // Where false directions are the rule, they are no measure of the others.
  const double typical_rad =
      std::min(centers.sigma_rad,
               RadFromDeg(kLittleOfDirectionsDeg) / options.outlier_reach);
  summary.agreement = std::make_shared<const SolutionAgreement>(
      FindAgreement(scene, centers.problem, centers.solution, rotations.matches,
                    {options.outlier_reach, typical_rad,
                     RadFromDeg(options.least_false_deg)}));
  summary.reliability_warnings = FindReliabilityWarnings(
      scene, *summary.agreement, {}, &summary.firm_evidence);
  summary.contests =
      ContestsAmong(scene, rotations, centers.problem, placed, summary);
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
                                             const RunContext& context) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  RotationAveragingOptions rotation = options.rotation;
  rotation.seed = context.seed;
  return AverageSceneRotations(scene, rotation, options.outlier_reach,
                               RadFromDeg(options.least_false_deg), context);
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
      const SceneCenters centers,
      SolveSceneCenters(*scene, rotations, options, context));
  SetPoses(centers.problem, centers.solution, scene);
  return Summarize(*scene, rotations, centers, options);
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
