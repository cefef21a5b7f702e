#include "lowlap/study/internal/robustness/table.h"

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>
#include <optional>
#include <utility>
#include <vector>

#include "lowlap/core/internal/median.h"
#include "lowlap/report/internal/table_text.h"

namespace lowlap {
namespace {

using Json = nlohmann::ordered_json;

std::string Number(double value) {
  return std::isfinite(value) ? NumberText(value, 6) : "";
}

// scenario, world and value: the start of a record.
std::vector<std::string> LevelCells(const RobustnessStudy& study,
                                    std::size_t scenario, std::size_t level) {
  const RobustnessScenario& info = study.scenarios[scenario];
  return {info.name, info.world, Number(info.levels[level].value)};
}

std::optional<RobustnessStatus> StatusFromName(const std::string& name) {
  for (const RobustnessStatus status :
       {RobustnessStatus::kSolved, RobustnessStatus::kFailed,
        RobustnessStatus::kOverTime, RobustnessStatus::kNotAsked}) {
    if (name == RobustnessStatusName(status)) return status;
  }
  return std::nullopt;
}

// Where a record belongs.
std::optional<RobustnessKey> FindKey(const Json& json,
                                     const RobustnessStudy& study) {
  const std::vector<std::string>& strategies = study.options.strategies;
  RobustnessKey key;
  json.at("seed").get_to(key.seed);
  for (; key.scenario < study.scenarios.size(); ++key.scenario) {
    const RobustnessScenario& scenario = study.scenarios[key.scenario];
    if (scenario.name != json.at("scenario") ||
        scenario.world != json.at("world")) {
      continue;
    }
    const auto level = std::find_if(
        scenario.levels.begin(), scenario.levels.end(),
        [&](const auto& each) { return each.value == json.at("value"); });
    const auto strategy = std::find(strategies.begin(), strategies.end(),
                                    json.at("strategy").get<std::string>());
    if (level == scenario.levels.end() || strategy == strategies.end()) break;
    key.level = static_cast<std::size_t>(level - scenario.levels.begin());
    key.strategy = static_cast<std::size_t>(strategy - strategies.begin());
    return key;
  }
  return std::nullopt;
}

}  // namespace

std::string TrialsCsv(const RobustnessStudy& study) {
  TextTable table;
  table.columns = {"scenario", "world",        "value",   "seed",
                   "strategy", "status",       "views",   "placed",
                   "right",    "median_error", "seconds", "note"};
  for (const auto& [key, outcome] : study.outcomes) {
    std::vector<std::string> row = LevelCells(study, key.scenario, key.level);
    for (std::string cell :
         {std::to_string(key.seed), study.options.strategies[key.strategy],
          std::string(RobustnessStatusName(outcome.status)),
          std::to_string(outcome.num_views), std::to_string(outcome.num_placed),
          std::to_string(outcome.num_right), Number(outcome.median_error),
          Number(outcome.seconds), outcome.note}) {
      row.push_back(std::move(cell));
    }
    table.rows.push_back(std::move(row));
  }
  return ToCsv(table);
}

std::string ToJsonLine(const RobustnessStudy& study, const RobustnessKey& key,
                       const RobustnessOutcome& outcome) {
  const RobustnessScenario& scenario = study.scenarios[key.scenario];
  const Json json = {{"scenario", scenario.name},
                     {"world", scenario.world},
                     {"value", scenario.levels[key.level].value},
                     {"seed", key.seed},
                     {"strategy", study.options.strategies[key.strategy]},
                     {"status", RobustnessStatusName(outcome.status)},
                     {"views", outcome.num_views},
                     {"placed", outcome.num_placed},
                     {"right", outcome.num_right},
                     {"median_error", outcome.median_error},  // infinite: null
                     {"seconds", outcome.seconds},
                     {"note", outcome.note}};
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

bool AddJsonLine(const std::string& line, RobustnessStudy* study) {
  try {
    const Json json = Json::parse(line);
    const std::optional<RobustnessKey> key = FindKey(json, *study);
    const auto status = StatusFromName(json.at("status"));
    if (!key || !status) return false;
    RobustnessOutcome outcome;
    outcome.status = *status;
    json.at("views").get_to(outcome.num_views);
    json.at("placed").get_to(outcome.num_placed);
    json.at("right").get_to(outcome.num_right);
    const Json& error = json.at("median_error");
    outcome.median_error = error.is_null() ? HUGE_VAL : error.get<double>();
    json.at("seconds").get_to(outcome.seconds);
    json.at("note").get_to(outcome.note);
    study->outcomes[*key] = std::move(outcome);
    return true;
  } catch (const Json::exception&) {
    return false;
  }
}

CurvePoint PointOf(const RobustnessStudy& study, std::size_t scenario,
                   std::size_t level, std::size_t strategy) {
  CurvePoint point;
  std::vector<double> errors, seconds;
  bool is_known = true;
  RobustnessKey key;
  key.scenario = scenario;
  key.level = level;
  // All strategies of all seeds of the level follow one another.
  for (auto it = study.outcomes.lower_bound(key);
       it != study.outcomes.end() && it->first.scenario == scenario &&
       it->first.level == level;
       ++it) {
    if (it->first.strategy != strategy) continue;
    const RobustnessOutcome& outcome = it->second;
    if (point.note.empty()) point.note = outcome.note;
    is_known = is_known && (outcome.status == RobustnessStatus::kSolved ||
                            outcome.status == RobustnessStatus::kFailed);
    const double num_views = outcome.num_views;
    point.placed_share += outcome.num_placed / num_views;
    point.right_share += outcome.num_right / num_views;
    errors.push_back(outcome.median_error);
    seconds.push_back(outcome.seconds);
  }
  point.is_known = is_known && !errors.empty();
  if (errors.empty()) return point;
  const auto count = static_cast<double>(errors.size());
  point.placed_share /= count;
  point.right_share /= count;
  point.median_error = Median(std::move(errors));
  point.seconds = Median(std::move(seconds));
  return point;
}

std::string CurvesCsv(const RobustnessStudy& study) {
  TextTable table;
  table.columns = {"scenario",     "world",        "value",
                   "strategy",     "placed_share", "right_share",
                   "median_error", "seconds",      "note"};
  for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
    for (std::size_t l = 0; l < study.scenarios[s].levels.size(); ++l) {
      for (std::size_t n = 0; n < study.options.strategies.size(); ++n) {
        const CurvePoint point = PointOf(study, s, l, n);
        if (!point.is_known && point.note.empty()) continue;
        std::vector<std::string> row = LevelCells(study, s, l);
        row.push_back(study.options.strategies[n]);
        for (const double value : {point.placed_share, point.right_share,
                                   point.median_error, point.seconds}) {
          row.push_back(point.is_known ? Number(value) : "");
        }
        row.push_back(point.note);
        table.rows.push_back(std::move(row));
      }
    }
  }
  return ToCsv(table);
}

}  // namespace lowlap
