#include "lowlap/pipeline/internal/output/summary_json.h"

#include <cmath>
#include <map>
#include <nlohmann/json.hpp>
#include <optional>

#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/averaging/reliability/internal/view_grades.h"
#include "lowlap/core/internal/view_json.h"
#include "lowlap/scene/internal/center_stddev.h"

namespace lowlap {
namespace {

using Json = nlohmann::ordered_json;

Json KindJson(const KindSupport& kind) {
  return {{"candidates", kind.candidates},
          {"inliers", kind.inliers},
          {"log10_nfa", kind.log10_nfa},
          {"threshold_px", kind.threshold_px},
          {"information_share", kind.information_share}};
}

Json RatioJson(const ScaleRatio& ratio) {
  Json json = {
      {"views", ratio.views},
      {"verdict", RatioVerdictName(ratio.verdict)},
      {"log_ratio", ratio.log_ratio},
      {"ratio", std::exp(ratio.log_ratio)},
      {"log_ratio_stddev", ratio.log_ratio_stddev},
      {"log_ratio_interval_95", {ratio.IntervalLow(), ratio.IntervalHigh()}},
      {"log10_nfa", ratio.log10_nfa}};
  for (const KindSupport& kind : ratio.kinds) json[kind.kind] = KindJson(kind);
  json["rejected_negative"] = ratio.num_rejected_negative;
  json["second_mode"] = nullptr;
  if (ratio.second_mode) {
    json["second_mode"] = {{"log_ratio", ratio.second_mode->log_ratio},
                           {"ratio", std::exp(ratio.second_mode->log_ratio)},
                           {"log10_nfa", ratio.second_mode->log10_nfa}};
  }
  return json;
}

Json RmseJson(const std::optional<double>& rmse_px) {
  return rmse_px ? Json(*rmse_px) : Json();
}

Json AdjustedKindJson(const KindAdjustment& kind) {
  return {{"landmarks", kind.landmarks},
          {"observations_used", kind.observations_used},
          {"observations_dropped", kind.observations_dropped},
          {"initial_rmse_px", RmseJson(kind.initial_rmse_px)},
          {"final_rmse_px", RmseJson(kind.final_rmse_px)},
          {"threshold_px", kind.threshold_px}};
}

Json AdjustedPairsJson(const KindAdjustment& pairs) {
  Json json = AdjustedKindJson(pairs);
  json["observations_surplus"] = pairs.observations_surplus;
  return json;
}

Json TriangulationJson(const TriangulationSummary& kind) {
  return {{"tracks", kind.tracks},
          {"landmarks", kind.landmarks},
          {"two_view_landmarks", kind.two_view_landmarks},
          {"too_few_views", kind.too_few_views},
          {"inconsistent", kind.inconsistent},
          {"behind_camera", kind.behind_camera},
          {"uncertain", kind.uncertain},
          {"implausible", kind.implausible},
          {"threshold_px", kind.threshold_px}};
}

Json IntrinsicJson(const Intrinsic& intrinsic) {
  return {
      {"model", CameraModelName(intrinsic.model)},
      {"fx", intrinsic.fx_px},
      {"fy", intrinsic.fy_px},
      {"principal_point",
       {intrinsic.principal_point_px.x(), intrinsic.principal_point_px.y()}},
      {"distortion", intrinsic.distortion}};
}

Json PreferencesJson(const AdjustmentSummary& adjustment) {
  Json preferences = Json::array();
  for (const CalibrationPreference& preference :
       adjustment.calibration_preferences) {
    preferences.push_back({{"intrinsics", preference.intrinsics},
                           {"parts", DescribeParts(preference.parts)},
                           {"deviations", preference.deviations},
                           {"held", IntrinsicJson(preference.held)},
                           {"preferred", IntrinsicJson(preference.preferred)}});
  }
  return preferences;
}

Json RivalsJson(const AdjustmentSummary& adjustment) {
  Json rivals = Json::array();
  for (const RivalOptimum& rival : adjustment.rivals) {
    Json distances = Json::array();
    for (const auto& [pose, distance] : rival.distances) {
      distances.push_back({{"pose", pose}, {"distance", distance}});
    }
    rivals.push_back({{"start", rival.start}, {"distances", distances}});
  }
  return rivals;
}

Json OutliersJson(const std::vector<OutlierEdge>& edges) {
  Json json = Json::array();
  for (const OutlierEdge& edge : edges) {
    json.push_back({{"views", edge.views},
                    {"reason", OutlierReasonName(edge.reason)},
                    {"error_deg", edge.error_deg}});
  }
  return json;
}

Json GradesJson(const PoseSummary& summary, const Scene& scene) {
  Json grades = Json::array();
  for (const auto& [view, graded] : GradeViews(summary)) {
    Json entry = {{"view", view}, {"grade", ViewGradeName(graded.grade)}};
    const Pose* pose = scene.FindPose(view);
    const auto stddev = pose ? CenterStddev(*pose) : std::nullopt;
    if (stddev) entry["center_stddev"] = *stddev;
    if (!graded.reasons.empty()) entry["reasons"] = graded.reasons;
    grades.push_back(std::move(entry));
  }
  return grades;
}

// What nothing confirms, or something contradicts.
void AddDoubts(const PoseSummary& summary, Json* poses) {
  Json loops = Json::array(), contested = Json::array();
  for (const LoopClosing& loop : summary.loops) {
    Json entry = {{"edges", loop.edges},
                  {"closing_deg", loop.closing_deg},
                  {"expected_deg", loop.expected_deg}};
    if (loop.left_out) entry["left_out"] = *loop.left_out;
    loops.push_back(std::move(entry));
  }
  for (const ContestedLink& link : summary.contested) {
    contested.push_back({{"edge", link.edge},
                         {"contradictions", link.contradictions},
                         {"views", link.views}});
  }
  Json contests = Json::array();
  for (const Contest& contest : summary.contests) {
    contests.push_back({{"links", contest.links},
                        {"contradictions", contest.contradictions},
                        {"views", contest.views}});
  }
  (*poses)["contests"] = std::move(contests);
  (*poses)["doubtful"] = summary.IsDoubtful();
  (*poses)["open_loops"] = std::move(loops);
  (*poses)["contested_links"] = std::move(contested);
  (*poses)["unchecked_edges"] = summary.unchecked;
  (*poses)["weak_ratios"] = summary.weak_ratios;
  Json doubts = Json::array();
  for (const ReliabilityWarning& doubt : summary.reliability_warnings) {
    Json entry = {{"views", doubt.views},
                  {"reason", WarningReasonName(doubt.reason)}};
    if (doubt.reason == WarningReason::kLostFeatures) {
      entry["fitting_share"] = doubt.share;
    }
    if (doubt.reason == WarningReason::kImprecise) {
      entry["stddev_share"] = doubt.share;
    }
    if (!doubt.against.empty()) entry["contradicted_by"] = doubt.against;
    if (!doubt.untold.empty()) entry["untold"] = doubt.untold;
    if (!doubt.missing.empty()) entry["missing"] = doubt.missing;
    if (!doubt.ratios.empty()) entry["ratios"] = doubt.ratios;
    doubts.push_back(std::move(entry));
  }
  (*poses)["doubtful_views"] = std::move(doubts);
}

// Pairs whose matches allow several motions.
Json MotionsJson(const std::vector<HypothesisDecision>& motions) {
  std::map<HypothesisGrounds, int> count;
  Json decisions = Json::array();
  for (const HypothesisDecision& decision : motions) {
    ++count[decision.grounds];
    Json entry = {{"views", decision.views},
                  {"decided_by", HypothesisGroundsName(decision.grounds)},
                  {"replaced", decision.replaced}};
    if (decision.grounds != HypothesisGrounds::kNone) {
      entry["margin"] = decision.margin;
    }
    decisions.push_back(std::move(entry));
  }
  return {{"pairs", motions.size()},
          {"decided_by_cycles", count[HypothesisGrounds::kCycles]},
          {"decided_by_triplets", count[HypothesisGrounds::kTriplets]},
          {"decided_by_structure", count[HypothesisGrounds::kStructure]},
          {"undecided", count[HypothesisGrounds::kNone]},
          {"decisions", std::move(decisions)}};
}

// How the poses were found.
void AddComposition(const SolveResult& solve, const Scene& scene, Json* json) {
  (*json)["ambiguous_motions"] = MotionsJson(solve.motions);
  Json& reconsidered = (*json)["reconsidered_poses"] = Json::array();
  for (const ReconsideredPose& pose : solve.reconsidered) {
    reconsidered.push_back({{"views", pose.views},
                            {"rotation_deg", pose.rotation_deg},
                            {"gained_digits", pose.gained_digits}});
  }
  Json& poses = (*json)["poses"];
  poses["components"] = solve.poses.components;
  poses["grades"] = GradesJson(solve.poses, scene);
  poses["outlier_edges"] = OutliersJson(solve.poses.outlier_edges);
  poses["kept_outliers"] = OutliersJson(solve.poses.kept_outliers);
  poses["left_out_ratios"] = solve.poses.left_out_ratios;
  poses["replaced_directions"] = Json::array();
  for (const ReplacedDirection& edge : solve.poses.matches.replaced) {
    poses["replaced_directions"].push_back(
        {{"views", edge.views}, {"error_deg", edge.error_deg}});
  }
  poses["untold_edges"] = solve.poses.matches.untold;
  AddDoubts(solve.poses, &poses);
  poses["median_rotation_residual_deg"] =
      solve.poses.median_rotation_residual_deg;
}

Json SolveJson(const RunSummary& summary, const Scene& scene) {
  const SolveResult& solve = *summary.solve;
  Json json;
  json["ratios"] = {{"triplets", solve.ratios.num_triplets},
                    {"meaningful", solve.ratios.num_meaningful},
                    {"not_meaningful", solve.ratios.num_not_meaningful},
                    {"without_candidates", solve.ratios.num_without_candidates},
                    {"rejected_negative", solve.ratios.num_rejected_negative}};
  json["poses"] = {{"views", solve.poses.num_views},
                   {"placed", solve.poses.num_placed},
                   {"unplaced", solve.poses.unplaced}};
  if (!summary.has_given_poses) AddComposition(solve, scene, &json);
  if (solve.structure) {
    json["structure"] = {{"points", TriangulationJson(solve.structure->points)},
                         {"lines", TriangulationJson(solve.structure->lines)},
                         {"coplanar_pairs", solve.structure->coplanar_pairs}};
  }
  if (solve.adjustment) {
    const AdjustmentSummary& a = *solve.adjustment;
    json["adjustment"] = {
        {"initial_cost", a.initial_cost},
        {"final_cost", a.final_cost},
        {"iterations", a.iterations},
        {"outlier_rounds", a.outlier_rounds},
        {"point_shape_exponent", a.point_shape_exponent},
        {"converged", a.converged},
        {"poses_adjusted", a.poses_adjusted},
        {"poses_without_observations", a.poses_without_observations},
        {"points", AdjustedKindJson(a.points)},
        {"lines", AdjustedKindJson(a.lines)},
        {"coplanar", AdjustedPairsJson(a.coplanar)},
        {"planes", a.planes},
        {"landmarks_on_planes", a.landmarks_on_planes},
        {"directions", a.directions},
        {"calibration_preferences", PreferencesJson(a)},
        {"rivals", RivalsJson(a)}};
  }
  return json;
}

}  // namespace

std::string ToJson(const RunSummary& summary, const Scene& scene) {
  Json json;
  json["command"] = summary.command;
  json["views"] = scene.views.size();
  json["pairs"] = Json::array();
  for (const PairReport& pair : summary.pairs) {
    Json entry = {{"views", pair.views},
                  {"accepted", pair.accepted},
                  {"point_matches", pair.num_point_matches},
                  {"point_inliers", pair.num_point_inliers},
                  {"line_matches", pair.num_line_matches},
                  {"line_inliers", pair.num_line_inliers},
                  {"log10_nfa", pair.log10_nfa},
                  {"geometry", pair.geometry},
                  {"no_parallax", pair.no_parallax}};
    if (!pair.accepted) entry["reason"] = pair.reason;
    json["pairs"].push_back(std::move(entry));
  }
  json["unrelated_views"] = Json::array();
  for (const UnrelatedView& view : summary.unrelated) {
    json["unrelated_views"].push_back({{"view", view.view},
                                       {"no_parallax", view.no_parallax},
                                       {"reason", view.reason}});
  }
  if (!summary.notes.empty()) json["notes"] = summary.notes;
  if (summary.solve) json["solve"] = SolveJson(summary, scene);
  if (summary.evaluation_before_adjustment) {
    json["evaluation_before_adjustment"] =
        Json::parse(ToJson(*summary.evaluation_before_adjustment));
  }
  if (summary.evaluation) {
    json["evaluation"] = Json::parse(ToJson(*summary.evaluation));
  }
  Json& cost = json["cost"];
  cost["stages"] = Json::array();
  for (const StageCost& stage : summary.stages) {
    cost["stages"].push_back({{"name", stage.name},
                              {"wall_s", stage.wall_s},
                              {"cpu_s", stage.cpu_s}});
  }
  cost["peak_memory_mb"] = PeakMemoryMb();
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string ToJson(const std::vector<ScaleRatio>& ratios) {
  Json json = Json::array();
  for (const ScaleRatio& ratio : ratios) json.push_back(RatioJson(ratio));
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

std::string ToJson(const RigidityReport& report) {
  Json json;
  json["connected_components"] = report.connected_components;
  json["isolated_views"] = report.isolated_views;
  json["groups"] = Json::array();
  for (const RigidGroup& group : report.groups) {
    json["groups"].push_back({{"views", group.views}, {"edges", group.edges}});
  }
  json["hinges"] = Json::array();
  for (const ArticulationView& hinge : report.articulation_views) {
    json["hinges"].push_back({{"view", hinge.view}, {"groups", hinge.groups}});
  }
  return json.dump(2, ' ', false, Json::error_handler_t::replace);
}

}  // namespace lowlap
