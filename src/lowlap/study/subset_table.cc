#include "lowlap/study/subset_table.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "lowlap/core/median.h"
#include "lowlap/report/svg_plot.h"
#include "lowlap/study/internal/csv_line.h"

namespace lowlap {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::size_t kNumFields = 11;

bool IsComplete(const SubsetOutcome& outcome) {
  return outcome.failure.empty() && outcome.num_placed == outcome.num_views;
}

bool HasErrors(const SubsetOutcome& outcome) {
  return outcome.worst_view != kInvalidId;
}

std::string Number(double value, const char* format) {
  char text[40];
  std::snprintf(text, sizeof text, format, value);
  return text;
}

std::string Joined(const std::vector<std::string>& words, char separator) {
  std::string text;
  for (const std::string& word : words) {
    if (!text.empty()) text += separator;
    text += word;
  }
  return text;
}

std::vector<std::string> Split(const std::string& text, char separator) {
  std::vector<std::string> words;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = std::min(text.find(separator, at), text.size());
    words.push_back(text.substr(at, end - at));
    at = end + 1;
  }
  return words;
}

template <class T, class Convert>
bool Parse(const std::string& text, const Convert& convert, T* value) {
  char* end = nullptr;
  *value = static_cast<T>(convert(text.c_str(), &end));
  return !text.empty() && *end == '\0';
}

bool ParseCount(const std::string& text, int* value) {
  return Parse(
      text, [](const char* c, char** e) { return std::strtol(c, e, 10); },
      value);
}

bool ParseError(const std::string& text, double* value) {
  if (text.empty()) return true;  // not known
  return Parse(
      text, [](const char* c, char** e) { return std::strtod(c, e); }, value);
}

bool ParseLine(const std::string& line,
               const std::map<std::string, ViewId>& view_of_name,
               SubsetOutcome* outcome) {
  const std::vector<std::string> fields = SplitCsvLine(line);
  if (fields.size() != kNumFields) return false;
  for (const std::string& id : Split(fields[0], '+')) {
    ViewId view = kInvalidId;
    if (!Parse(
            id, [](const char* c, char** e) { return std::strtoul(c, e, 10); },
            &view)) {
      return false;
    }
    outcome->dropped.push_back(view);
  }
  if (!fields[5].empty()) {
    const auto found = view_of_name.find(fields[5]);
    if (found == view_of_name.end()) return false;
    outcome->worst_view = found->second;
  }
  outcome->doubts = Split(fields[8], ';');
  outcome->failure = fields[9];
  return !outcome->dropped.empty() && (fields[7] == "0" || fields[7] == "1") &&
         (fields[7] == "1") == !outcome->doubts.empty() &&
         ParseCount(fields[1], &outcome->num_views) &&
         ParseCount(fields[2], &outcome->num_placed) &&
         ParseError(fields[3], &outcome->mean_error) &&
         ParseError(fields[4], &outcome->max_error) &&
         ParseError(fields[6], &outcome->mean_error_before_adjustment) &&
         ParseError(fields[10], &outcome->seconds);
}

// (error, share of all outcomes up to it), a step for each value.
LineSeries CumulativeShare(std::string name, std::vector<double> errors,
                           std::size_t total) {
  LineSeries series;
  series.name = std::move(name);
  std::sort(errors.begin(), errors.end());
  for (std::size_t n = 0; n < errors.size(); ++n) {
    series.points.emplace_back(
        errors[n], static_cast<double>(n + 1) / static_cast<double>(total));
  }
  return series;
}

std::string Share(std::size_t part, std::size_t whole) {
  const double percent =
      whole > 0 ? 100.0 * static_cast<double>(part) / static_cast<double>(whole)
                : 0.0;
  return std::to_string(part) + " of " + std::to_string(whole) + " (" +
         Number(percent, "%.1f") + " %)";
}

}  // namespace

Status SubsetBounds::Validate() const {
  if (!(accurate > 0) || !(failed >= accurate)) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "subsets: the bound of a good error must be positive, and "
                     "that of a failure not below it");
  }
  return {};
}

bool IsSilentFailure(const SubsetOutcome& outcome, const SubsetBounds& bounds) {
  return HasErrors(outcome) && outcome.max_error > bounds.failed &&
         outcome.doubts.empty();
}

SubsetSummary SummarizeSubsets(const std::vector<SubsetOutcome>& outcomes,
                               const SubsetBounds& bounds) {
  SubsetSummary summary;
  summary.num_subsets = outcomes.size();
  std::vector<double> mean_errors, max_errors;
  for (const SubsetOutcome& outcome : outcomes) {
    summary.seconds += outcome.seconds;
    if (!outcome.doubts.empty()) ++summary.num_flagged;
    if (HasErrors(outcome) && outcome.max_error > bounds.failed) {
      ++(outcome.doubts.empty() ? summary.num_silent_failures
                                : summary.num_flagged_failures);
    }
    if (!IsComplete(outcome) || !HasErrors(outcome)) continue;
    ++summary.num_complete;
    if (outcome.mean_error <= bounds.accurate) ++summary.num_accurate_mean;
    if (outcome.max_error <= bounds.accurate) ++summary.num_accurate;
    mean_errors.push_back(outcome.mean_error);
    max_errors.push_back(outcome.max_error);
  }
  if (!mean_errors.empty()) {
    summary.median_mean_error = Median(std::move(mean_errors));
    summary.median_max_error = Median(std::move(max_errors));
  }
  return summary;
}

std::string SubsetCsvHeader() {
  return "dropped,views,placed,mean_error,max_error,worst_view,"
         "mean_error_before_adjustment,doubtful,reasons,failure,seconds\n";
}

std::string ToCsvLine(const SubsetOutcome& outcome, const Scene& scene) {
  std::vector<std::string> dropped;
  for (const ViewId view : outcome.dropped) {
    dropped.push_back(std::to_string(view));
  }
  const bool known = HasErrors(outcome);
  const auto error = [&](double value) {
    return known ? Number(value, "%.6f") : std::string();
  };
  std::string line = Joined(dropped, '+');
  for (const std::string& field :
       {std::to_string(outcome.num_views), std::to_string(outcome.num_placed),
        error(outcome.mean_error), error(outcome.max_error),
        known ? QuotedCsvField(scene.views.at(outcome.worst_view).filename)
              : std::string(),
        error(outcome.mean_error_before_adjustment),
        std::string(outcome.doubts.empty() ? "0" : "1"),
        Joined(outcome.doubts, ';'),
        outcome.failure.empty() ? std::string()
                                : QuotedCsvField(outcome.failure),
        Number(outcome.seconds, "%.2f")}) {
    line += "," + field;
  }
  return line + "\n";
}

Result<std::vector<SubsetOutcome>> ParseSubsetCsv(const std::string& text,
                                                  const Scene& scene) {
  std::map<std::string, ViewId> view_of_name;
  for (const auto& [id, view] : scene.views) view_of_name[view.filename] = id;
  std::vector<SubsetOutcome> outcomes;
  std::size_t number = 0;
  for (std::size_t at = 0; at < text.size();) {
    const std::size_t end = text.find('\n', at);
    if (end == std::string::npos) break;  // its writer was stopped
    const std::string line = text.substr(at, end + 1 - at);
    at = end + 1;
    ++number;
    if (number == 1) {
      if (line == SubsetCsvHeader()) continue;
      return MakeError(ErrorCode::kParse, "not a table of subsets", {},
                       "line 1");
    }
    SubsetOutcome outcome;
    if (!ParseLine(line.substr(0, line.size() - 1), view_of_name, &outcome)) {
      return MakeError(ErrorCode::kParse, "not a line of a table of subsets",
                       {}, "line " + std::to_string(number));
    }
    outcomes.push_back(std::move(outcome));
  }
  return outcomes;
}

std::string ToText(const SubsetSummary& summary, const SubsetBounds& bounds) {
  const std::size_t total = summary.num_subsets;
  const std::string good = Number(bounds.accurate, "%g");
  const std::string bad = Number(bounds.failed, "%g");
  const auto median = [&](double error) {
    return summary.num_complete > 0 ? Number(error, "%.4f") : std::string("-");
  };
  return "subsets: " + std::to_string(total) +
         "\nall views placed: " + Share(summary.num_complete, total) +
         "\n  mean position error at most " + good + ": " +
         Share(summary.num_accurate_mean, total) + "\n  every camera within " +
         good + ": " + Share(summary.num_accurate, total) +
         "\n  median of the mean errors " + median(summary.median_mean_error) +
         ", of the largest errors " + median(summary.median_max_error) +
         "\nflagged as doubtful: " + Share(summary.num_flagged, total) +
         "\na camera beyond " + bad + ": " +
         std::to_string(summary.num_flagged_failures) +
         " flagged, silent failures: " +
         std::to_string(summary.num_silent_failures) +
         "\nseconds per subset: " +
         Number(total > 0 ? summary.seconds / static_cast<double>(total) : 0.0,
                "%.2f") +
         "\n";
}

std::string ToJson(const SubsetSummary& summary, const SubsetBounds& bounds) {
  const double total =
      static_cast<double>(std::max<std::size_t>(summary.num_subsets, 1));
  const auto median = [&](double error) {
    return summary.num_complete > 0 ? Json(error) : Json();
  };
  const Json json = {
      {"subsets", summary.num_subsets},
      {"accurate_bound", bounds.accurate},
      {"failed_bound", bounds.failed},
      {"complete", summary.num_complete},
      {"accurate_by_mean", summary.num_accurate_mean},
      {"accurate", summary.num_accurate},
      {"share_accurate_by_mean",
       static_cast<double>(summary.num_accurate_mean) / total},
      {"share_accurate", static_cast<double>(summary.num_accurate) / total},
      {"median_mean_error", median(summary.median_mean_error)},
      {"median_max_error", median(summary.median_max_error)},
      {"flagged", summary.num_flagged},
      {"flagged_failures", summary.num_flagged_failures},
      {"silent_failures", summary.num_silent_failures}};
  return json.dump(2) + "\n";
}

Result<std::string> DrawSubsets(const std::vector<SubsetOutcome>& outcomes) {
  std::vector<double> mean_errors, max_errors;
  for (const SubsetOutcome& outcome : outcomes) {
    if (!IsComplete(outcome) || !HasErrors(outcome)) continue;
    mean_errors.push_back(outcome.mean_error);
    max_errors.push_back(outcome.max_error);
  }
  LinePlot plot;
  plot.title = "Position errors over " + std::to_string(outcomes.size()) +
               " subsets of the views";
  plot.note = std::to_string(mean_errors.size()) +
              " with all their views placed; the others never count";
  plot.x.label = "position error up to (unit of the true cameras)";
  plot.x.scale = AxisScale::kLog10;
  plot.y.label = "share of all subsets";
  plot.y.min = 0.0;
  plot.y.max = 1.0;
  plot.series.push_back(CumulativeShare(
      "mean over the cameras", std::move(mean_errors), outcomes.size()));
  plot.series.push_back(CumulativeShare(
      "largest of a camera", std::move(max_errors), outcomes.size()));
  return DrawLinePlot(plot);
}

}  // namespace lowlap
