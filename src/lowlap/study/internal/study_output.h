#pragma once

#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/pipeline/stage_log.h"
#include "lowlap/report/internal/svg_plot.h"
#include "lowlap/report/internal/table_text.h"

namespace lowlap {

// What the outputs of studies have in common.

using StudyJson = nlohmann::ordered_json;

/// An object by stage.
StudyJson ToStudyJson(const std::vector<StageCost>& costs);
/// File names may hold any bytes; what is not UTF-8 is replaced.
std::string DumpText(const StudyJson& json);

/// The cost of a stage; nullptr if it was not reached.
const StageCost* FindCost(const std::vector<StageCost>& costs,
                          const std::string& stage);
/// STAGE_wall_s and STAGE_cpu_s for every stage.
void AddCostColumns(const std::vector<std::string>& stages, TextTable* table);
void AddCostCells(const std::vector<StageCost>& costs,
                  const std::vector<std::string>& stages,
                  std::vector<std::string>* row);

/// Every plot as (file name, SVG).
Result<std::vector<std::pair<std::string, std::string>>> DrawBarPlots(
    const std::vector<std::pair<std::string, BarPlot>>& plots);

}  // namespace lowlap
