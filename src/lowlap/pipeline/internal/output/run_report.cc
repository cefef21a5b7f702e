#include "lowlap/pipeline/internal/output/run_report.h"

#include <cstdio>
#include <utility>

#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/averaging/internal/pose_warnings.h"
#include "lowlap/pipeline/internal/output/ratio_table.h"

namespace lowlap {
namespace {

std::string Number(double value, const char* format = "%.4g") {
  char text[32];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string NameOf(const Scene& scene, ViewId view) {
  return scene.views.at(view).filename;
}

ReportTable ScaleRatioTable(const Scene& scene) {
  ReportTable table;
  table.title = "Scale ratios";
  table.note =
      "Baseline (middle, last) over baseline (first, middle), with the "
      "interval that holds it with a probability of 95 %. A ratio is used if "
      "chance does not explain it (log10 NFA below 0). Kinds of evidence: "
      "inliers/candidates, and percent of the information in that order. "
      "Second "
      "mode: what the features that disagree would choose.";
  RatioTable ratios = MakeRatioTable(scene.scale_ratios);
  table.columns = std::move(ratios.columns);
  table.columns.insert(table.columns.begin(), "first, middle, last");
  for (std::size_t n = 0; n < scene.scale_ratios.size(); ++n) {
    const ScaleRatio& ratio = scene.scale_ratios[n];
    std::vector<std::string> row = std::move(ratios.rows[n]);
    row.insert(row.begin(), NameOf(scene, ratio.views.first) + ", " +
                                NameOf(scene, ratio.views.middle) + ", " +
                                NameOf(scene, ratio.views.last));
    table.rows.push_back(std::move(row));
  }
  return table;
}

ReportTable PairTable(const std::vector<PairReport>& pairs,
                      const Scene& scene) {
  ReportTable table;
  table.title = "Pairs of views";
  table.columns = {"pair",      "point matches", "inliers", "line matches",
                   "plausible", "log10 NFA",     "geometry"};
  for (const PairReport& pair : pairs) {
    table.rows.push_back({NameOf(scene, pair.views.first) + ", " +
                              NameOf(scene, pair.views.second),
                          std::to_string(pair.num_point_matches),
                          std::to_string(pair.num_point_inliers),
                          std::to_string(pair.num_line_matches),
                          std::to_string(pair.num_line_inliers),
                          Number(pair.log10_nfa, "%.1f"),
                          pair.accepted ? pair.geometry : pair.reason});
  }
  return table;
}

ReportTable ErrorTable(const PoseEvaluation& evaluation) {
  ReportTable table;
  table.title = "Cameras against the truth";
  table.note =
      "After a similarity alignment of the centres; positions in the unit of "
      "the truth.";
  table.columns = {"camera", "position error", "rotation error (deg)"};
  for (const ViewPoseError& view : evaluation.views) {
    table.rows.push_back({view.name, Number(view.position_error),
                          Number(view.rotation_error_deg)});
  }
  return table;
}

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
  if (solve.adjustment) {
    content->figures.emplace_back(
        "point RMSE",
        Number(solve.adjustment->points.final_rmse_px, "%.2f px"));
    content->figures.emplace_back(
        "line RMSE", Number(solve.adjustment->lines.final_rmse_px, "%.2f px"));
    for (std::string& note :
         DescribeCalibrationPreferences(*solve.adjustment)) {
      content->notes.push_back(std::move(note));
    }
  }
  for (std::string& warning : PoseWarnings(poses, scene)) {
    content->warnings.push_back(std::move(warning));
  }
}

}  // namespace

ReportContent MakeReport(const RunSummary& summary, const Scene& scene) {
  ReportContent content;
  content.title = "lowlap " + summary.command;
  for (const UnrelatedView& view : summary.unrelated) {
    content.warnings.push_back(NameOf(scene, view.view) +
                               " has no relative pose: " + view.reason);
  }
  content.notes = summary.notes;
  if (summary.solve) AddSolve(*summary.solve, scene, &content);
  if (summary.evaluation && summary.evaluation->position.count > 0) {
    content.figures.emplace_back("mean position error",
                                 Number(summary.evaluation->position.mean));
    content.tables.push_back(ErrorTable(*summary.evaluation));
  }
  if (!scene.scale_ratios.empty())
    content.tables.push_back(ScaleRatioTable(scene));
  if (!summary.pairs.empty()) {
    content.tables.push_back(PairTable(summary.pairs, scene));
  }
  return content;
}

}  // namespace lowlap
