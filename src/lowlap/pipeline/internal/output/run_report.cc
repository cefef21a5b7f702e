#include "lowlap/pipeline/internal/output/run_report.h"

#include <map>
#include <utility>
#include <vector>

#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/adjustment/internal/uncertainty/rival_optima.h"
#include "lowlap/averaging/reliability/internal/pose_warnings.h"
#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/page_photographs.h"
#include "lowlap/pipeline/internal/output/ratio_profiles.h"
#include "lowlap/scene/internal/align_poses.h"

namespace lowlap {
namespace {

void AddSolve(const SolveResult& solve, const Scene& scene,
              ReportContent* content) {
  const PoseSummary& poses = solve.poses;
  content->figures.emplace_back("cameras placed",
                                std::to_string(poses.num_placed) + " of " +
                                    std::to_string(poses.num_views));
  content->figures.emplace_back("points",
                                std::to_string(scene.structure.size()));
  content->figures.emplace_back("lines",
                                std::to_string(scene.line_structure.size()));
  content->figures.emplace_back("coplanar pairs",
                                std::to_string(scene.coplanar_pairs.size()));
  if (solve.adjustment) {
    const AdjustmentSummary& adjustment = *solve.adjustment;
    if (const auto rmse_px = adjustment.points.final_rmse_px) {
      content->figures.emplace_back("point RMSE", Format("%.2f px", *rmse_px));
    }
    if (const auto rmse_px = adjustment.lines.final_rmse_px) {
      content->figures.emplace_back("line RMSE", Format("%.2f px", *rmse_px));
    }
    for (std::string& note : DescribeCalibrationPreferences(adjustment)) {
      content->notes.push_back(std::move(note));
    }
    for (std::string& note : DescribeRivals(scene, adjustment)) {
      content->notes.push_back(std::move(note));
    }
    content->before_adjustment = ReportStage{
        solve.poses_before_adjustment, solve.structure_before_adjustment.points,
        solve.structure_before_adjustment.lines};
  }
  for (PoseWarning& warning : PoseWarningsByView(poses, scene)) {
    content->warnings.push_back(
        {std::move(warning.text), std::move(warning.views)});
  }
}

std::string OutlierNote(OutlierReason reason) {
  switch (reason) {
    case OutlierReason::kRotation:
      return "its rotation contradicts the others";
    case OutlierReason::kDirection:
      return "its direction contradicts the solved centres";
    case OutlierReason::kContradicted:
      return "contradicted by more evidence, confirmed by no cycle";
    case OutlierReason::kOpenLoop:
      return "least evidence in a loop that does not close";
    case OutlierReason::kMatches:
      return "its own matches contradict it";
    case OutlierReason::kOutweighed:
      return "third views bear out what contradicts it, and hardly it";
    case OutlierReason::kLookAlike:
      return "joins places that look alike: beside its matches, what both "
             "views should see is missing";
  }
  return "";
}

// Those that were tried, and all relative poses.
std::vector<ReportPair> MakePairs(const RunSummary& summary,
                                  const Scene& scene) {
  std::map<ViewPair, ReportPair> pairs;
  for (const PairReport& report : summary.pairs) {
    ReportPair& pair = pairs[report.views];
    pair.note = report.accepted ? report.geometry : report.reason;
    pair.num_point_matches = report.num_point_matches;
    pair.num_line_matches = report.num_line_matches;
    pair.log10_nfa = report.log10_nfa;
  }
  for (const auto& [views, pose] : scene.relative_poses) {
    ReportPair& pair = pairs[views];
    pair.log10_nfa = pose.log10_nfa;
    pair.is_used = scene.FindPose(views.first) && scene.FindPose(views.second);
  }
  if (summary.solve) {
    for (const OutlierEdge& edge : summary.solve->poses.outlier_edges) {
      pairs[edge.views].is_used = false;
      pairs[edge.views].note = OutlierNote(edge.reason);
    }
  }
  std::vector<ReportPair> list;
  for (auto& [views, pair] : pairs) {
    pair.views = views;
    list.push_back(std::move(pair));
  }
  return list;
}

// The truth in the frame of the scene, where the two can be aligned.
std::optional<ReportTruth> MakeTruth(const RunSummary& summary,
                                     const Scene& scene) {
  if (!summary.truth || !summary.evaluation ||
      summary.evaluation->scope != EvaluationScope::kFull) {
    return std::nullopt;
  }
  std::vector<Pose> truths, solved;
  for (const auto& [view, pose] : *summary.truth) {
    if (const Pose* in_scene = scene.FindPose(view)) {
      truths.push_back(pose);
      solved.push_back(*in_scene);
    }
  }
  const auto scene_from_truth = AlignPoses(truths, solved);
  if (!scene_from_truth) return std::nullopt;
  ReportTruth truth;
  for (const auto& [view, pose] : *summary.truth) {
    truth.poses[view] = {pose.rotation * scene_from_truth->rotation.transpose(),
                         *scene_from_truth * pose.center};
  }
  for (const ViewPoseError& error : summary.evaluation->views) {
    truth.position_errors[error.view] = error.position_error;
    truth.rotation_errors_deg[error.view] = error.rotation_error_deg;
  }
  return truth;
}

void AddTruth(const RunSummary& summary, const Scene& scene,
              ReportContent* content) {
  if (!summary.evaluation || summary.evaluation->position.count == 0) return;
  content->figures.emplace_back(
      "mean position error", Format("%.4g", summary.evaluation->position.mean));
  content->truth = MakeTruth(summary, scene);
}

}  // namespace

Result<ReportContent> MakeReport(const RunSummary& summary, const Scene& scene,
                                 const RunContext& context) {
  ReportContent content;
  content.title = "lowlap " + summary.command;
  for (const UnrelatedView& view : summary.unrelated) {
    content.warnings.push_back(
        {scene.NameOf(view.view) + " has no relative pose: " + view.reason,
         {view.view}});
  }
  content.notes = summary.notes;
  if (summary.solve) AddSolve(*summary.solve, scene, &content);
  AddTruth(summary, scene, &content);
  content.pairs = MakePairs(summary, scene);
  content.detected = summary.detected;
  LOWLAP_ASSIGN_OR_RETURN(content.photographs, PagePhotographs(scene, context));
  LOWLAP_ASSIGN_OR_RETURN(content.profiles,
                          ProfilesForPage(scene, summary.kinds, context));
  return content;
}

}  // namespace lowlap
