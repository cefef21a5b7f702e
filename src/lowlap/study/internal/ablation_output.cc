#include <functional>
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

std::optional<ErrorStatistics> StatisticsOf(const AblationCase& entry) {
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

// The adjustment of a case; nullptr if there was none.
const AdjustmentSummary* AdjustmentOf(const AblationCase& entry) {
  return entry.adjusted && !entry.failure ? &entry.adjustment : nullptr;
}

// What a row of a table says of a case.
struct Row {
  std::string name;
  std::function<std::string(const AblationCase&)> cell;
};

Row PositionRow(const char* name, double ErrorStatistics::*member) {
  return {name, [member](const AblationCase& entry) {
            const auto errors = StatisticsOf(entry);
            return errors ? NumberText((*errors).*member, 4) : "-";
          }};
}

Row CountRow(const char* name,
             std::size_t (*count)(const AdjustmentSummary& adjustment)) {
  return {name, [count](const AblationCase& entry) {
            const AdjustmentSummary* adjustment = AdjustmentOf(entry);
            return adjustment != nullptr ? std::to_string(count(*adjustment))
                                         : "-";
          }};
}

std::vector<Row> ErrorRows(int num_views) {
  return {PositionRow("mean position error", &ErrorStatistics::mean),
          PositionRow("median", &ErrorStatistics::median),
          PositionRow("max", &ErrorStatistics::max),
          {"cameras placed", [num_views](const AblationCase& entry) {
             return std::to_string(entry.num_placed) + "/" +
                    std::to_string(num_views);
           }}};
}

std::vector<Row> RatioRows() {
  return {{"ratios used",
           [](const AblationCase& entry) {
             return std::to_string(entry.ratios.num_meaningful) + "/" +
                    std::to_string(entry.ratios.num_triplets);
           }},
          {"median error of a ratio (%)", [](const AblationCase& entry) {
             return entry.abs_log_ratio.count > 0
                        ? NumberText(100 * entry.abs_log_ratio.median, 3)
                        : "-";
           }}};
}

std::size_t NumPairs(const AdjustmentSummary& adjustment) {
  return adjustment.coplanar.observations_used;
}
std::size_t NumPlanes(const AdjustmentSummary& adjustment) {
  return adjustment.planes;
}
std::size_t NumDirections(const AdjustmentSummary& adjustment) {
  return adjustment.directions;
}

// At the end of the adjustment.
std::vector<Row> TieRows() {
  return {{"mean rotation error (deg)",
           [](const AblationCase& entry) {
             return StatisticsOf(entry)
                        ? NumberText(entry.errors.rotation_deg.mean, 4)
                        : "-";
           }},
          CountRow("coplanar pairs", NumPairs),
          CountRow("planes", NumPlanes),
          CountRow("directions", NumDirections)};
}

// A column per case, as in the paper.
std::string CaseTable(const std::string& title,
                      const std::vector<AblationCase>& cases, int num_views,
                      const std::vector<Row>& further_rows) {
  TextTable table;
  table.columns = {title};
  std::vector<Row> rows = ErrorRows(num_views);
  rows.insert(rows.end(), further_rows.begin(), further_rows.end());
  for (const Row& row : rows) table.rows.push_back({row.name});
  std::string failures;
  for (const AblationCase& entry : cases) {
    table.columns.push_back(entry.name);
    for (std::size_t n = 0; n < rows.size(); ++n) {
      table.rows[n].push_back(rows[n].cell(entry));
    }
    if (entry.failure) {
      failures += entry.name + ": " + entry.failure->ToString() + "\n";
    }
  }
  return ToAlignedText(table) + failures;
}

void AddRecords(const char* name, const std::vector<AblationCase>& cases,
                int num_views, TextTable* table) {
  for (const AblationCase& entry : cases) {
    const auto errors = StatisticsOf(entry);
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
    const AdjustmentSummary* adjustment = AdjustmentOf(entry);
    for (const auto count : {NumPairs, NumPlanes, NumDirections}) {
      row.push_back(adjustment != nullptr ? std::to_string(count(*adjustment))
                                          : "");
    }
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
                      {"meaningful", entry.ratios.num_meaningful}};
    if (entry.abs_log_ratio.count > 0) {
      json["ratios"]["abs_log_error_median"] = entry.abs_log_ratio.median;
      json["ratios"]["abs_log_error_max"] = entry.abs_log_ratio.max;
    }
    if (const AdjustmentSummary* adjustment = AdjustmentOf(entry)) {
      json["held_by"] = {{"coplanar_pairs", NumPairs(*adjustment)},
                         {"planes", NumPlanes(*adjustment)},
                         {"directions", NumDirections(*adjustment)}};
    }
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
    const auto errors = StatisticsOf(entry);
    series.values.push_back(errors ? std::optional(errors->mean)
                                   : std::nullopt);
  }
  plot.series.push_back(std::move(series));
  return plot;
}

}  // namespace

std::string ToText(const Ablation& ablation) {
  return CaseTable("All features, before adjustment", ablation.criteria,
                   ablation.num_views, RatioRows()) +
         "\n" +
         CaseTable("A contrario, before adjustment", ablation.features,
                   ablation.num_views, RatioRows()) +
         "\n" +
         CaseTable("All features, adjustment held by", ablation.ties,
                   ablation.num_views, TieRows()) +
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
                   "abs_log_ratio_error_max",
                   "coplanar_pairs",
                   "planes",
                   "directions"};
  AddCostColumns(Stages(), &table);
  AddRecords("criteria", ablation.criteria, ablation.num_views, &table);
  AddRecords("features", ablation.features, ablation.num_views, &table);
  AddRecords("ties", ablation.ties, ablation.num_views, &table);
  return ToCsv(table);
}

std::string ToJson(const Ablation& ablation) {
  Json json;
  json["views"] = ablation.num_views;
  json["criteria"] = CasesJson(ablation.criteria);
  json["features"] = CasesJson(ablation.features);
  json["ties"] = CasesJson(ablation.ties);
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
                 ablation.features)},
       {"ties.svg", CaseBars("What holds the bundle adjustment",
                             "All features, a contrario", ablation.ties)}});
}

Status WriteAblation(const Ablation& ablation, const std::string& folder) {
  LOWLAP_ASSIGN_OR_RETURN(auto files, DrawAblation(ablation));
  files.emplace_back("ablate.csv", ToCsv(ablation));
  files.emplace_back("ablate.json", ToJson(ablation) + "\n");
  return WriteTextFiles(files, folder);
}

}  // namespace lowlap
