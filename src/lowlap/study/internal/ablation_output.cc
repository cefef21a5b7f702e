#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/output_folder.h"
#include "lowlap/scale/evidence/evidence_registry.h"
#include "lowlap/study/internal/ablation.h"
#include "lowlap/study/internal/study_output.h"

namespace lowlap {
namespace {

using Json = StudyJson;

const std::vector<std::string>& Stages() {
  static const auto* stages = new std::vector<std::string>{
      "scale ratios", "poses", "structure", "adjustment"};
  return *stages;
}

std::optional<ErrorStatistics> PositionErrors(const AblationCase& entry) {
  if (entry.errors.scope != EvaluationScope::kFull) return std::nullopt;
  return entry.errors.position;
}

std::string FeatureList(const ScaleOptions& scale) {
  std::string list;
  for (const std::string& word : EvidenceRegistry::BuiltIn().Features()) {
    if (scale.Asks(word)) list += (list.empty() ? "" : "+") + word;
  }
  return list;
}

bool IsFixed(const AblationCase& entry) {
  return entry.scale.criterion == ScaleCriterion::kFixedThreshold;
}

// A column per case, as in the paper.
std::string CaseTable(const std::string& title,
                      const std::vector<AblationCase>& cases, int num_views) {
  TextTable table;
  table.columns = {title};
  table.rows = {{"mean position error"},
                {"median"},
                {"max"},
                {"cameras placed"},
                {"ratios used"},
                {"median error of a ratio (%)"}};
  std::string failures;
  for (const AblationCase& entry : cases) {
    table.columns.push_back(entry.name);
    const auto errors = PositionErrors(entry);
    const auto cell = [&](double ErrorStatistics::*member) {
      return errors ? NumberText((*errors).*member, 4) : std::string("-");
    };
    table.rows[0].push_back(cell(&ErrorStatistics::mean));
    table.rows[1].push_back(cell(&ErrorStatistics::median));
    table.rows[2].push_back(cell(&ErrorStatistics::max));
    table.rows[3].push_back(std::to_string(entry.num_placed) + "/" +
                            std::to_string(num_views));
    table.rows[4].push_back(std::to_string(entry.ratios.num_meaningful) + "/" +
                            std::to_string(entry.ratios.num_triplets));
    table.rows[5].push_back(
        entry.abs_log_ratio.count > 0
            ? NumberText(100 * entry.abs_log_ratio.median, 3)
            : "-");
    if (entry.failure) {
      failures += entry.name + ": " + entry.failure->ToString() + "\n";
    }
  }
  return ToAlignedText(table) + failures;
}

void AddRecords(const char* name, const std::vector<AblationCase>& cases,
                int num_views, TextTable* table) {
  for (const AblationCase& entry : cases) {
    const auto errors = PositionErrors(entry);
    const auto cell = [&](double ErrorStatistics::*member) {
      return errors ? NumberText((*errors).*member, 9) : std::string();
    };
    std::vector<std::string> row = {
        name,
        entry.name,
        IsFixed(entry) ? "fixed threshold" : "a contrario",
        IsFixed(entry) ? NumberText(entry.scale.threshold_px, 9) : "",
        FeatureList(entry.scale),
        entry.adjusted ? "yes" : "no",
        entry.failure ? entry.failure->ToString() : "",
        std::to_string(entry.num_placed),
        std::to_string(num_views),
        cell(&ErrorStatistics::mean),
        cell(&ErrorStatistics::median),
        cell(&ErrorStatistics::max),
        errors ? NumberText(entry.errors.rotation_deg.mean, 9) : "",
        std::to_string(entry.ratios.num_triplets),
        std::to_string(entry.ratios.num_meaningful),
        entry.abs_log_ratio.count > 0
            ? NumberText(entry.abs_log_ratio.median, 9)
            : "",
        entry.abs_log_ratio.count > 0 ? NumberText(entry.abs_log_ratio.max, 9)
                                      : ""};
    AddCostCells(entry.costs, Stages(), &row);
    table->rows.push_back(std::move(row));
  }
}

Json CasesJson(const std::vector<AblationCase>& cases) {
  Json list = Json::array();
  for (const AblationCase& entry : cases) {
    Json json = {{"case", entry.name}};
    if (IsFixed(entry)) {
      json["criterion"] = "fixed_threshold";
      json["threshold_px"] = entry.scale.threshold_px;
    } else {
      json["criterion"] = "a_contrario";
    }
    json["features"] = FeatureList(entry.scale);
    json["adjusted"] = entry.adjusted;
    if (entry.failure) json["failure"] = entry.failure->ToString();
    json["placed"] = entry.num_placed;
    json["evaluation"] = Json::parse(ToJson(entry.errors));
    json["ratios"] = {{"triplets", entry.ratios.num_triplets},
                      {"meaningful", entry.ratios.num_meaningful},
                      {"abs_log_error_median", entry.abs_log_ratio.median},
                      {"abs_log_error_max", entry.abs_log_ratio.max}};
    json["cost"] = ToStudyJson(entry.costs);
    list.push_back(std::move(json));
  }
  return list;
}

BarPlot CaseBars(const std::string& title, const std::string& note,
                 const std::vector<AblationCase>& cases) {
  BarPlot plot;
  plot.title = title;
  plot.note = note;
  plot.value.label = "mean position error (unit of the true cameras)";
  BarSeries series;
  series.name = "mean position error";
  for (const AblationCase& entry : cases) {
    plot.groups.push_back(entry.name);
    const auto errors = PositionErrors(entry);
    series.values.push_back(errors ? std::optional(errors->mean)
                                   : std::nullopt);
  }
  plot.series.push_back(std::move(series));
  return plot;
}

}  // namespace

std::string ToText(const Ablation& ablation) {
  return CaseTable("All features, before adjustment", ablation.criteria,
                   ablation.num_views) +
         "\n" +
         CaseTable("A contrario, before adjustment", ablation.features,
                   ablation.num_views) +
         "\npositions in the unit of the true cameras, of the cameras placed, "
         "after a similarity\nalignment\n";
}

std::string ToCsv(const Ablation& ablation) {
  TextTable table;
  table.columns = {"table",
                   "case",
                   "criterion",
                   "threshold_px",
                   "features",
                   "adjusted",
                   "failure",
                   "placed",
                   "views",
                   "position_error_mean",
                   "position_error_median",
                   "position_error_max",
                   "rotation_error_mean_deg",
                   "triplets",
                   "meaningful_ratios",
                   "abs_log_ratio_error_median",
                   "abs_log_ratio_error_max"};
  AddCostColumns(Stages(), &table);
  AddRecords("criteria", ablation.criteria, ablation.num_views, &table);
  AddRecords("features", ablation.features, ablation.num_views, &table);
  return ToCsv(table);
}

std::string ToJson(const Ablation& ablation) {
  Json json;
  json["views"] = ablation.num_views;
  json["criteria"] = CasesJson(ablation.criteria);
  json["features"] = CasesJson(ablation.features);
  return DumpText(json);
}

Result<std::vector<std::pair<std::string, std::string>>> DrawAblation(
    const Ablation& ablation) {
  return DrawBarPlots(
      {{"criteria.svg",
        CaseBars("Fixed thresholds and the a-contrario criterion",
                 "All features, before bundle adjustment", ablation.criteria)},
       {"features.svg",
        CaseBars("Kinds of features",
                 "A contrario, before bundle adjustment but for the last",
                 ablation.features)}});
}

Status WriteAblation(const Ablation& ablation, const std::string& folder) {
  LOWLAP_ASSIGN_OR_RETURN(auto files, DrawAblation(ablation));
  files.emplace_back("ablate.csv", ToCsv(ablation));
  files.emplace_back("ablate.json", ToJson(ablation) + "\n");
  return WriteTextFiles(files, folder);
}

}  // namespace lowlap
