#include <algorithm>
#include <filesystem>
#include <optional>
#include <string>
#include <system_error>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/output_folder.h"
#include "lowlap/study/compare_strategies.h"
#include "lowlap/study/internal/comparison_figures.h"
#include "lowlap/study/internal/study_output.h"

namespace lowlap {
namespace {

using Json = StudyJson;

std::string Cell(const std::optional<double>& value, int digits,
                 const char* absent) {
  return value ? NumberText(*value, digits) : absent;
}

const char* StatusOf(const StrategyResult& result) {
  if (result.failure) return "failed";
  if (result.num_placed == 0) return "none placed";
  return result.unplaced.empty() ? "all placed" : "some placed";
}

// In words; empty if all went well.
std::string ReasonOf(const StrategyResult& result) {
  std::string reason = result.limit;
  if (result.failure) {
    reason += (reason.empty() ? "" : " ") + std::string("Failed: ") +
              result.failure->ToString() + ".";
  }
  return reason;
}

Json QualityJson(const SolutionQuality& quality) {
  const Consistency& consistency = quality.consistency;
  Json json;
  if (quality.errors) json["evaluation"] = Json::parse(ToJson(*quality.errors));
  if (quality.difference) {
    json["difference_to_reference_in_mean_baselines"] = *quality.difference;
  }
  json["direction_error_deg"] = consistency.direction_deg;
  json["abs_log_ratio_error"] = consistency.abs_log_ratio;
  json["points"] = consistency.num_points;
  json["reprojection_rmse_px"] = consistency.reprojection_rmse_px;
  return json;
}

// What a comparison with a truth, or without one, left there before.
Status RemoveOtherPlot(const Comparison& comparison,
                       const std::string& folder) {
  namespace fs = std::filesystem;
  const fs::path other =
      fs::path(folder) / PositionPlotName(!comparison.has_truth);
  std::error_code error;
  if (!fs::is_regular_file(fs::symlink_status(other, error))) return {};
  fs::remove(other, error);
  if (!error) return {};
  return MakeError(ErrorCode::kIo, "cannot be removed: " + error.message(),
                   other.string());
}

}  // namespace

std::string ToText(const Comparison& comparison) {
  const bool adjusted = IsAdjusted(comparison);
  TextTable table;
  table.columns = {"strategy", "placed"};
  const std::string what = comparison.has_truth ? "error" : "difference";
  for (const char* stage : {"before", "after"}) {
    if (stage == std::string("after") && !adjusted) continue;
    table.columns.push_back(what + " " + stage);
    table.columns.emplace_back("max");
    table.columns.emplace_back("RMSE px");
  }
  for (const char* column :
       {"direction deg", "ratio %", "iterations", "averaging s"}) {
    table.columns.emplace_back(column);
  }
  if (adjusted) table.columns.emplace_back("adjustment s");
  for (const StrategyResult& result : comparison.results) {
    std::vector<std::string> row = {result.strategy,
                                    std::to_string(result.num_placed) + "/" +
                                        std::to_string(comparison.num_views)};
    const Figures before = FiguresBefore(result);
    const auto add = [&](const std::optional<double>& value, int digits) {
      row.push_back(Cell(value, digits, "-"));
    };
    const auto add_solution = [&](const Figures& figures) {
      const auto& errors =
          comparison.has_truth ? figures.position : figures.difference;
      add(MeanOf(errors), 4);
      add(MaxOf(errors), 4);
      add(figures.rmse_px, 3);
    };
    add_solution(before);
    if (adjusted) add_solution(FiguresAfter(result));
    add(MedianOf(before.direction_deg), 3);
    const auto log_ratio = MedianOf(before.log_ratio);
    add(log_ratio ? std::optional(100 * *log_ratio) : std::nullopt, 3);
    row.push_back(std::to_string(result.num_iterations));
    add(WallOf(result, "averaging"), 3);
    if (adjusted) add(WallOf(result, "adjustment"), 3);
    table.rows.push_back(std::move(row));
  }
  std::string text =
      std::to_string(comparison.num_views) + " views, " +
      std::to_string(comparison.num_edges) + " relative poses (" +
      std::to_string(comparison.num_outlier_edges) + " more left out), " +
      std::to_string(comparison.num_ratios) + " scale ratios\n\n" +
      ToAlignedText(table) + "\n";
  text += comparison.has_truth
              ? "error: mean distance of the cameras placed to the true ones, "
                "in the truth's unit\n"
          : comparison.reference.empty()
              ? "difference: none, as no strategy places any camera\n"
              : "difference: mean distance to the cameras of '" +
                    comparison.reference +
                    "', in its mean baseline; there are no true cameras to "
                    "judge by\n";
  text +=
      "direction, ratio: median disagreement of the solved centres (before "
      "adjustment) with\nthe measured directions and scale ratios\n";
  // Strategies that are stopped by the same thing share a line.
  std::vector<std::pair<std::string, std::string>> names_of_reason;
  for (const StrategyResult& result : comparison.results) {
    const std::string reason = ReasonOf(result);
    if (reason.empty()) continue;
    const auto known =
        std::find_if(names_of_reason.begin(), names_of_reason.end(),
                     [&](const auto& entry) { return entry.first == reason; });
    if (known == names_of_reason.end()) {
      names_of_reason.emplace_back(reason, result.strategy);
    } else {
      known->second += ", " + result.strategy;
    }
  }
  for (const auto& [reason, names] : names_of_reason) {
    text.append("\n").append(names).append(": ").append(reason).append("\n");
  }
  return text;
}

std::string ToCsv(const Comparison& comparison) {
  TextTable table;
  table.columns = {"strategy", "status", "reason",     "placed",
                   "views",    "parts",  "iterations", "adjustment_iterations"};
  for (const std::string stage : {"before_", "after_"}) {
    for (const char* column :
         {"position_error_mean", "position_error_median", "position_error_max",
          "rotation_error_mean_deg", "difference_mean", "difference_max",
          "direction_error_median_deg", "abs_log_ratio_error_median", "points",
          "reprojection_rmse_px"}) {
      table.columns.push_back(stage + column);
    }
  }
  const std::vector<std::string> stages = {"averaging", "structure",
                                           "adjustment"};
  AddCostColumns(stages, &table);
  for (const StrategyResult& result : comparison.results) {
    std::vector<std::string> row = {
        result.strategy,
        StatusOf(result),
        ReasonOf(result),
        std::to_string(result.num_placed),
        std::to_string(comparison.num_views),
        std::to_string(result.num_components),
        std::to_string(result.num_iterations),
        result.after ? std::to_string(result.num_adjustment_iterations) : ""};
    const auto add = [&](const std::optional<double>& value) {
      row.push_back(Cell(value, 9, ""));
    };
    for (const Figures& figures :
         {FiguresBefore(result), FiguresAfter(result)}) {
      add(MeanOf(figures.position));
      add(MedianOf(figures.position));
      add(MaxOf(figures.position));
      add(MeanOf(figures.rotation_deg));
      add(MeanOf(figures.difference));
      add(MaxOf(figures.difference));
      add(MedianOf(figures.direction_deg));
      add(MedianOf(figures.log_ratio));
      row.push_back(figures.num_points ? std::to_string(*figures.num_points)
                                       : "");
      add(figures.rmse_px);
    }
    AddCostCells(result.costs, stages, &row);
    table.rows.push_back(std::move(row));
  }
  return ToCsv(table);
}

std::string ToJson(const Comparison& comparison, const Scene& scene) {
  Json json;
  json["views"] = comparison.num_views;
  json["relative_poses"] = comparison.num_edges;
  json["relative_poses_left_out"] = comparison.num_outlier_edges;
  json["scale_ratios"] = comparison.num_ratios;
  json["reference"] = comparison.reference;
  json["strategies"] = Json::array();
  for (const StrategyResult& result : comparison.results) {
    Json entry;
    entry["strategy"] = result.strategy;
    entry["status"] = StatusOf(result);
    entry["reason"] = ReasonOf(result);
    entry["placed"] = result.num_placed;
    entry["parts"] = result.num_components;
    Json unplaced = Json::array();
    for (const ViewId view : result.unplaced) {
      unplaced.push_back({{"view", view}, {"name", scene.NameOf(view)}});
    }
    entry["unplaced"] = std::move(unplaced);
    entry["iterations"] = result.num_iterations;
    if (result.num_placed > 0) {
      entry["before_adjustment"] = QualityJson(result.before);
    }
    if (result.after) {
      entry["adjustment_iterations"] = result.num_adjustment_iterations;
      entry["after_adjustment"] = QualityJson(*result.after);
    }
    entry["cost"] = ToStudyJson(result.costs);
    json["strategies"].push_back(std::move(entry));
  }
  json["cost"] = ToStudyJson(comparison.shared_costs);
  return DumpText(json);
}

Status WriteComparison(const Comparison& comparison, const Scene& scene,
                       const std::string& folder) {
  LOWLAP_ASSIGN_OR_RETURN(auto files, DrawComparison(comparison));
  files.emplace_back("compare.csv", ToCsv(comparison));
  files.emplace_back("compare.json", ToJson(comparison, scene) + "\n");
  LOWLAP_RETURN_IF_ERROR(WriteTextFiles(files, folder));
  return RemoveOtherPlot(comparison, folder);
}

}  // namespace lowlap
