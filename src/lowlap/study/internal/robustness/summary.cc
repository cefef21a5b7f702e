#include "lowlap/study/internal/robustness/summary.h"

#include <algorithm>

#include "lowlap/study/internal/robustness/table.h"

namespace lowlap {
namespace {

bool WasAsked(const RobustnessStudy& study, std::size_t scenario,
              std::size_t strategy) {
  const std::size_t num_levels = study.scenarios[scenario].levels.size();
  for (std::size_t level = 0; level < num_levels; ++level) {
    if (PointOf(study, scenario, level, strategy).is_known) return true;
  }
  return false;
}

}  // namespace

std::optional<double> HoldsUpTo(const RobustnessStudy& study,
                                std::size_t scenario, std::size_t strategy) {
  const RobustnessScenario& info = study.scenarios[scenario];
  std::optional<double> value;
  for (std::size_t n = 0; n < info.levels.size(); ++n) {
    const std::size_t level =
        info.hard_when_small ? info.levels.size() - 1 - n : n;
    const CurvePoint point = PointOf(study, scenario, level, strategy);
    if (!point.is_known || point.right_share < kHoldingShare) break;
    value = info.levels[level].value;
  }
  return value;
}

TextTable BreakdownTable(const RobustnessStudy& study) {
  TextTable table;
  table.columns = {"scenario"};
  for (const std::string& name : study.options.strategies) {
    table.columns.push_back(name);
  }
  for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
    std::vector<std::string> row = {study.scenarios[s].Id()};
    for (std::size_t n = 0; n < study.options.strategies.size(); ++n) {
      const std::optional<double> value = HoldsUpTo(study, s, n);
      row.push_back(value                   ? NumberText(*value, 4)
                    : WasAsked(study, s, n) ? "-"
                                            : "");
    }
    table.rows.push_back(std::move(row));
  }
  return table;
}

std::vector<BetterStrategy> WhereFirstIsWorse(const RobustnessStudy& study,
                                              double least_gap) {
  std::vector<BetterStrategy> found;
  for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
    for (std::size_t l = 0; l < study.scenarios[s].levels.size(); ++l) {
      const CurvePoint first = PointOf(study, s, l, 0);
      if (!first.is_known) continue;
      BetterStrategy better;
      better.scenario = s;
      better.level = l;
      better.right_share_of_first = better.right_share = first.right_share;
      for (std::size_t n = 1; n < study.options.strategies.size(); ++n) {
        const CurvePoint point = PointOf(study, s, l, n);
        if (point.is_known && point.right_share > better.right_share) {
          better.strategy = n;
          better.right_share = point.right_share;
        }
      }
      if (better.right_share - first.right_share >= least_gap) {
        found.push_back(better);
      }
    }
  }
  std::stable_sort(found.begin(), found.end(),
                   [](const auto& a, const auto& b) {
                     return a.right_share - a.right_share_of_first >
                            b.right_share - b.right_share_of_first;
                   });
  return found;
}

std::string SummaryText(const RobustnessStudy& study) {
  const std::string& first = study.options.strategies.front();
  std::string text = "At least " + NumberText(100 * kHoldingShare, 3) +
                     " % of the views are right up to (line_, twins_: down "
                     "to):\n" +
                     ToAlignedText(BreakdownTable(study));
  const std::vector<BetterStrategy> better = WhereFirstIsWorse(study);
  text += "\nWhere another strategy places more views right than " + first +
          ": " + (better.empty() ? "nowhere\n" : "\n");
  TextTable table;
  table.columns = {"scenario", "value", first, "best", "of"};
  for (const BetterStrategy& each : better) {
    const RobustnessScenario& scenario = study.scenarios[each.scenario];
    table.rows.push_back({scenario.Id(),
                          NumberText(scenario.levels[each.level].value, 4),
                          NumberText(each.right_share_of_first, 3),
                          NumberText(each.right_share, 3),
                          study.options.strategies[each.strategy]});
  }
  return better.empty() ? text : text + ToAlignedText(table);
}

}  // namespace lowlap
