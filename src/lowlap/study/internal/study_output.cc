#include "lowlap/study/internal/study_output.h"

#include <algorithm>

namespace lowlap {

StudyJson ToStudyJson(const std::vector<StageCost>& costs) {
  StudyJson json = StudyJson::object();
  for (const StageCost& cost : costs) {
    json[cost.name] = {{"wall_s", cost.wall_s}, {"cpu_s", cost.cpu_s}};
  }
  return json;
}

std::string DumpText(const StudyJson& json) {
  return json.dump(2, ' ', false, StudyJson::error_handler_t::replace);
}

const StageCost* FindCost(const std::vector<StageCost>& costs,
                          const std::string& stage) {
  const auto found =
      std::find_if(costs.begin(), costs.end(),
                   [&](const StageCost& cost) { return cost.name == stage; });
  return found == costs.end() ? nullptr : &*found;
}

void AddCostColumns(const std::vector<std::string>& stages, TextTable* table) {
  for (std::string stage : stages) {
    std::replace(stage.begin(), stage.end(), ' ', '_');
    table->columns.push_back(stage + "_wall_s");
    table->columns.push_back(stage + "_cpu_s");
  }
}

void AddCostCells(const std::vector<StageCost>& costs,
                  const std::vector<std::string>& stages,
                  std::vector<std::string>* row) {
  for (const std::string& stage : stages) {
    const StageCost* cost = FindCost(costs, stage);
    row->push_back(cost == nullptr ? "" : NumberText(cost->wall_s, 4));
    row->push_back(cost == nullptr ? "" : NumberText(cost->cpu_s, 4));
  }
}

Result<std::vector<std::pair<std::string, std::string>>> DrawBarPlots(
    const std::vector<std::pair<std::string, BarPlot>>& plots) {
  std::vector<std::pair<std::string, std::string>> drawn;
  for (const auto& [name, plot] : plots) {
    auto svg = DrawBarPlot(plot);
    if (!svg) return tl::unexpected<Error>(svg.error());
    drawn.emplace_back(name, std::move(*svg));
  }
  return drawn;
}

}  // namespace lowlap
