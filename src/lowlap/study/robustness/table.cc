#include "lowlap/study/robustness/table.h"

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "lowlap/core/median.h"
#include "lowlap/study/internal/csv_line.h"

namespace lowlap {
namespace {

constexpr std::size_t kNumFields = 12;

std::string Number(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

// scenario, world and value: the start of a line.
std::string LevelFields(const RobustnessStudy& study, std::size_t scenario,
                        std::size_t level) {
  const RobustnessScenario& info = study.scenarios[scenario];
  return info.name + "," + info.world + "," + Number(info.levels[level].value) +
         ",";
}

template <class T>
bool ParseNumber(const std::string& text, T* value) {
  char* end = nullptr;
  const double number = std::strtod(text.c_str(), &end);
  if (text.empty() || *end != '\0' || !(number >= 0) ||
      number > static_cast<double>(std::numeric_limits<T>::max())) {
    return false;
  }
  *value = static_cast<T>(number);
  return true;
}

bool ParseSeed(const std::string& text, std::uint64_t* seed) {
  char* end = nullptr;
  *seed = std::strtoull(text.c_str(), &end, 10);
  return !text.empty() && *end == '\0';
}

std::optional<RobustnessStatus> StatusFromName(const std::string& name) {
  for (const RobustnessStatus status :
       {RobustnessStatus::kSolved, RobustnessStatus::kFailed,
        RobustnessStatus::kOverTime, RobustnessStatus::kNotAsked}) {
    if (name == RobustnessStatusName(status)) return status;
  }
  return std::nullopt;
}

/// Where a line belongs, by its first three fields and its strategy.
class Index {
 public:
  explicit Index(const RobustnessStudy& study) {
    for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
      for (std::size_t l = 0; l < study.scenarios[s].levels.size(); ++l) {
        levels_[LevelFields(study, s, l)] = {s, l};
      }
    }
    for (const std::string& name : study.options.strategies) {
      strategies_.emplace(name, strategies_.size());
    }
  }

  bool Find(const std::vector<std::string>& fields, RobustnessKey* key) const {
    const auto level =
        levels_.find(fields[0] + "," + fields[1] + "," + fields[2] + ",");
    const auto strategy = strategies_.find(fields[4]);
    if (level == levels_.end() || strategy == strategies_.end()) return false;
    key->scenario = level->second.first;
    key->level = level->second.second;
    key->strategy = strategy->second;
    return ParseSeed(fields[3], &key->seed);
  }

 private:
  std::map<std::string, std::pair<std::size_t, std::size_t>> levels_;
  std::map<std::string, std::size_t> strategies_;
};

bool ParseLine(const std::string& line, const Index& index,
               RobustnessStudy* study) {
  const std::vector<std::string> fields = SplitCsvLine(line);
  if (fields.size() != kNumFields) return false;
  RobustnessKey key;
  RobustnessOutcome outcome;
  const auto status = StatusFromName(fields[5]);
  if (!status || !index.Find(fields, &key)) return false;
  outcome.status = *status;
  outcome.median_error = HUGE_VAL;
  outcome.note = fields[11];
  const bool is_whole =
      ParseNumber(fields[6], &outcome.num_views) &&
      ParseNumber(fields[7], &outcome.num_placed) &&
      ParseNumber(fields[8], &outcome.num_right) &&
      (fields[9].empty() || ParseNumber(fields[9], &outcome.median_error)) &&
      ParseNumber(fields[10], &outcome.seconds);
  if (is_whole) study->outcomes[key] = std::move(outcome);
  return is_whole;
}

}  // namespace

std::string TrialsCsvHeader() {
  return "scenario,world,value,seed,strategy,status,views,placed,right,"
         "median_error,seconds,note\n";
}

std::string ToCsvLine(const RobustnessStudy& study, const RobustnessKey& key,
                      const RobustnessOutcome& outcome) {
  return LevelFields(study, key.scenario, key.level) +
         std::to_string(key.seed) + "," +
         study.options.strategies[key.strategy] + "," +
         RobustnessStatusName(outcome.status) + "," +
         std::to_string(outcome.num_views) + "," +
         std::to_string(outcome.num_placed) + "," +
         std::to_string(outcome.num_right) + "," +
         Number(outcome.median_error) + "," + Number(outcome.seconds) + "," +
         QuotedCsvField(outcome.note) + "\n";
}

std::string TrialsCsv(const RobustnessStudy& study) {
  std::string csv = TrialsCsvHeader();
  for (const auto& [key, outcome] : study.outcomes) {
    csv += ToCsvLine(study, key, outcome);
  }
  return csv;
}

Status ParseTrialsCsv(const std::string& text, RobustnessStudy* study) {
  const Index index(*study);
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;
    const std::string line = text.substr(at, end - at);
    at = end + 1;
    ++number;
    if (number == 1 ? line + "\n" != TrialsCsvHeader()
                    : !ParseLine(line, index, study)) {
      return MakeError(ErrorCode::kParse, "is no trial of this study", {},
                       "line " + std::to_string(number));
    }
  }
  return {};
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
  std::string csv =
      "scenario,world,value,strategy,placed_share,right_share,median_error,"
      "seconds,note\n";
  for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
    for (std::size_t l = 0; l < study.scenarios[s].levels.size(); ++l) {
      for (std::size_t n = 0; n < study.options.strategies.size(); ++n) {
        const CurvePoint point = PointOf(study, s, l, n);
        if (!point.is_known && point.note.empty()) continue;
        csv += LevelFields(study, s, l) + study.options.strategies[n] + ",";
        csv += point.is_known ? Number(point.placed_share) + "," +
                                    Number(point.right_share) + "," +
                                    Number(point.median_error) + "," +
                                    Number(point.seconds)
                              : ",,,";
        csv += "," + QuotedCsvField(point.note) + "\n";
      }
    }
  }
  return csv;
}

}  // namespace lowlap
