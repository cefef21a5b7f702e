#include "lowlap/averaging/scene_poses.h"

#include <algorithm>
#include <set>
#include <utility>

#include "lowlap/averaging/internal/contests.h"
#include "lowlap/averaging/internal/contradicted_ratio.h"
#include "lowlap/averaging/internal/error_limits.h"
#include "lowlap/averaging/internal/hanging_views.h"
#include "lowlap/averaging/internal/reliability_warnings.h"
#include "lowlap/averaging/strategies/internal/graph_scales.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

// Edges whose direction is beyond `reach` deviations from the centres of
// component 0. `sigma_rad` is found first if it is 0, and then stays: what is
// right must not be eroded round by round.
std::vector<OutlierEdge> DirectionOutliers(const TranslationProblem& problem,
                                           const TranslationSolution& solution,
                                           const PoseOptions& options,
                                           double* sigma_rad) {
  struct Residual {
    const DirectionEdge* edge;
    double angle_rad;
  };
  std::vector<Residual> residuals;
  std::vector<double> angles;
  for (const DirectionEdge& edge : problem.edges) {
    if (solution.component[edge.first] != 0 ||
        solution.component[edge.second] != 0) {
      continue;
    }
    const Vec3 baseline = solution.center_in_world[edge.second] -
                          solution.center_in_world[edge.first];
    if (!(baseline.norm() > 0)) continue;
    residuals.push_back(
        {&edge, AngleBetween(baseline, edge.direction_in_world)});
    angles.push_back(residuals.back().angle_rad);
  }
  if (*sigma_rad == 0) *sigma_rad = ResidualStddev<2>(std::move(angles));
  const ErrorLimits limits = LimitsOf(options);
  std::vector<OutlierEdge> outliers;
  for (const Residual& residual : residuals) {
    const DirectionEdge& edge = *residual.edge;
    if (residual.angle_rad > limits.DirectionRad(*sigma_rad, edge.stddev_rad)) {
      outliers.push_back(
          {ViewPair{problem.views[edge.first], problem.views[edge.second]},
           OutlierReason::kDirection, DegFromRad(residual.angle_rad)});
    }
  }
  return outliers;
}

// Ratios that are not meaningful, but the only ones on which candidates agree,
// enough of them to bear each other out or any two, for a view that has not
// been placed.
std::set<ViewTriplet> WeakRatios(const Scene& scene,
                                 const TranslationProblem& problem,
                                 const TranslationSolution& solution,
                                 bool with_agreement) {
  std::set<ViewId> unplaced;
  for (std::size_t n = 0; n < problem.views.size(); ++n) {
    if (solution.component[n] != 0) unplaced.insert(problem.views[n]);
  }
  std::set<ViewTriplet> weak;
  for (const ScaleRatio& ratio : scene.scale_ratios) {
    const ViewTriplet& views = ratio.views;
    if (ratio.verdict == RatioVerdict::kNotMeaningful &&
        (ratio.HasAgreement() ||
         (!with_agreement && ratio.NumInliers() >= 2)) &&
        unplaced.count(views.first) + unplaced.count(views.middle) +
                unplaced.count(views.last) >
            0) {
      weak.insert(views);
    }
  }
  return weak;
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
                                   const TranslationProblem& problem,
                                   const TranslationSolution& solution,
                                   const PoseSummary& summary) {
  const auto evidence = [&](const ViewPair& views) {
    return 1 + std::max(0.0, -scene.relative_poses.at(views).log10_nfa);
  };
  EvidenceOfPairs in_use, rejected;
  std::set<ViewId> placed;
  for (std::size_t n = 0; n < problem.views.size(); ++n) {
    if (solution.component[n] == 0) placed.insert(problem.views[n]);
  }
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
        rejected[edge.views] = evidence(edge.views);
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
  const GraphScalesAverager graph;
  const TranslationAverager& averager =
      options.averager ? *options.averager : graph;
  const bool with_tracks = averager.NeedsTracks();
  std::vector<OutlierEdge> outliers = rotations.outliers;
  TranslationProblem problem = MakeTranslationProblem(
      *scene, rotations.cam_from_world, PairsOf(outliers), {}, with_tracks);
  auto solution = averager.Solve(problem, context);
  if (!solution) return tl::unexpected<Error>(solution.error());

  std::set<ViewTriplet> weak;
  for (const bool with_agreement : {true, false}) {
    std::set<ViewTriplet> more =
        WeakRatios(*scene, problem, *solution, with_agreement);
    more.insert(weak.begin(), weak.end());
    if (more.size() == weak.size()) continue;
    TranslationProblem wider = MakeTranslationProblem(
        *scene, rotations.cam_from_world, PairsOf(outliers), more, with_tracks);
    auto again = averager.Solve(wider, context);
    if (!again) return tl::unexpected<Error>(again.error());
    if (again->NumPlaced() > solution->NumPlaced()) {
      problem = std::move(wider);
      solution = std::move(again);
      weak = std::move(more);
    }
  }

  double sigma_rad = 0;
  std::vector<OutlierEdge> kept;
  std::vector<ViewTriplet> left_out_ratios;
  while (true) {
    const std::vector<OutlierEdge> wrong =
        DirectionOutliers(problem, *solution, options, &sigma_rad);
    if (wrong.empty()) break;
    std::vector<OutlierEdge> more = outliers;
    more.insert(more.end(), wrong.begin(), wrong.end());
    TranslationProblem smaller = MakeTranslationProblem(
        *scene, rotations.cam_from_world, PairsOf(more), weak, with_tracks);
    auto again = averager.Solve(smaller, context);
    if (!again) return tl::unexpected<Error>(again.error());
    if (again->NumPlaced() < solution->NumPlaced()) {
      LOWLAP_ASSIGN_OR_RETURN(
          auto without, SolveWithoutContradictedRatio(
                            problem, averager, *solution,
                            [&](const TranslationSolution& other) {
                              return DirectionOutliers(problem, other, options,
                                                       &sigma_rad)
                                  .empty();
                            },
                            context));
      if (without) {
        left_out_ratios = {without->ratio};
        solution = std::move(without->solution);
      } else {
        kept = wrong;
      }
      break;
    }
    outliers = std::move(more);
    problem = std::move(smaller);
    solution = std::move(again);
  }
  std::sort(outliers.begin(), outliers.end(),
            [](const OutlierEdge& a, const OutlierEdge& b) {
              return a.views < b.views;
            });

  SetPoses(problem, *solution, scene);
  PoseSummary summary;
  summary.num_views = static_cast<int>(scene->views.size());
  summary.components.resize(static_cast<std::size_t>(solution->num_components));
  std::set<ViewId> placed;
  for (std::size_t n = 0; n < problem.views.size(); ++n) {
    if (solution->component[n] < 0) continue;
    summary.components[solution->component[n]].push_back(problem.views[n]);
    if (solution->component[n] == 0) placed.insert(problem.views[n]);
  }
  for (const auto& entry : scene->views) {
    if (placed.count(entry.first) == 0) summary.unplaced.push_back(entry.first);
  }
  summary.num_placed = static_cast<int>(placed.size());
  summary.outlier_edges = std::move(outliers);
  summary.kept_outliers = std::move(kept);
  summary.left_out_ratios = std::move(left_out_ratios);
  summary.matches = rotations.matches;
  summary.loops = rotations.loops;
  const auto is_placed = [&](ViewId view) { return placed.count(view) > 0; };
  for (ContestedLink link : rotations.contested) {
    if (!is_placed(link.edge.first) || !is_placed(link.edge.second)) continue;
    link.views.erase(
        std::remove_if(link.views.begin(), link.views.end(),
                       [&](ViewId view) { return !is_placed(view); }),
        link.views.end());
    summary.contested.push_back(std::move(link));
  }
  for (const ViewPair& edge : rotations.unchecked) {
    if (is_placed(edge.first) && is_placed(edge.second)) {
      summary.unchecked.push_back(edge);
    }
  }
  for (const ViewTriplet& views : weak) {
    if (is_placed(views.first) && is_placed(views.middle) &&
        is_placed(views.last)) {
      summary.weak_ratios.push_back(views);
    }
  }
  // Where false directions are the rule, they are no measure of the others.
  const double typical_rad = std::min(
      sigma_rad, RadFromDeg(kLittleOfDirectionsDeg) / options.outlier_reach);
  summary.agreement = std::make_shared<const SolutionAgreement>(
      FindAgreement(*scene, problem, *solution, rotations.matches,
                    {options.outlier_reach, typical_rad,
                     RadFromDeg(options.least_false_deg)}));
  summary.reliability_warnings = FindReliabilityWarnings(
      *scene, *summary.agreement, {}, &summary.firm_evidence);
  summary.contests = ContestsAmong(*scene, problem, *solution, summary);
  WarnOfHangingViews(&summary);
  summary.num_edges = static_cast<int>(problem.edges.size());
  summary.num_ratios =
      static_cast<int>(problem.ratios.size() - summary.left_out_ratios.size());
  summary.median_rotation_residual_deg =
      DegFromRad(rotations.median_residual_rad);
  return summary;
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
