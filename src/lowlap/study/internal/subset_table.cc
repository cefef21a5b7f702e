#include "lowlap/study/internal/subset_table.h"

#include <algorithm>
#include <map>
#include <nlohmann/json.hpp>
#include <utility>

#include "lowlap/core/internal/format.h"
#include "lowlap/core/internal/joined.h"
#include "lowlap/core/internal/median.h"
#include "lowlap/report/internal/svg_plot.h"
#include "lowlap/report/internal/table_text.h"

namespace lowlap {
namespace {

using Json = nlohmann::ordered_json;

bool IsComplete(const SubsetOutcome& outcome) {
  return outcome.failure.empty() && outcome.num_placed == outcome.num_views;
}

bool HasErrors(const SubsetOutcome& outcome) {
  return outcome.worst_view != kInvalidId;
}

// What a line of the log holds.
template <class Outcome, class Visit>
void VisitMembers(Outcome& outcome, const Visit& visit) {
  visit("dropped", outcome.dropped);
  visit("views", outcome.num_views);
  visit("placed", outcome.num_placed);
  visit("mean_error", outcome.mean_error);
  visit("max_error", outcome.max_error);
  visit("worst_view", outcome.worst_view);
  visit("mean_error_before_adjustment", outcome.mean_error_before_adjustment);
  visit("firm_errors", outcome.firm_errors);
  visit("doubtful_errors", outcome.doubtful_errors);
  visit("doubts", outcome.doubts);
  visit("failure", outcome.failure);
  visit("seconds", outcome.seconds);
}

// Adds those that are good, and those that are wrong.
void CountCameras(const std::map<ViewId, double>& errors,
                  const SubsetBounds& bounds, std::size_t* num_good,
                  std::size_t* num_wrong) {
  for (const auto& [view, error] : errors) {
    *num_good += error <= bounds.accurate ? 1 : 0;
    *num_wrong += error > bounds.failed ? 1 : 0;
  }
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
         Format("%.1f", percent) + " %)";
}

// Empty without any.
std::string LargestText(const std::map<ViewId, double>& errors) {
  double largest = -1;
  for (const auto& [view, error] : errors) largest = std::max(largest, error);
  return largest < 0 ? "" : Format("%.6f", largest);
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

std::vector<ViewId> WrongFirmViews(const SubsetOutcome& outcome,
                                   const SubsetBounds& bounds) {
  std::vector<ViewId> views;
  for (const auto& [view, error] : outcome.firm_errors) {
    if (error > bounds.failed) views.push_back(view);
  }
  return views;
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
    CountCameras(outcome.firm_errors, bounds, &summary.num_good_cameras,
                 &summary.num_wrong_cameras);
    CountCameras(outcome.doubtful_errors, bounds, &summary.num_good_doubted,
                 &summary.num_wrong_cameras);
    summary.num_wrong_firm += WrongFirmViews(outcome, bounds).size();
    if (!IsComplete(outcome) || !HasErrors(outcome)) continue;
    ++summary.num_complete;
    if (outcome.mean_error <= bounds.accurate) ++summary.num_accurate_mean;
    if (outcome.max_error <= bounds.accurate) ++summary.num_accurate;
    mean_errors.push_back(outcome.mean_error);
    max_errors.push_back(outcome.max_error);
  }
  summary.num_good_cameras += summary.num_good_doubted;
  if (!mean_errors.empty()) {
    summary.median_mean_error = Median(std::move(mean_errors));
    summary.median_max_error = Median(std::move(max_errors));
  }
  return summary;
}

std::string ToCsv(const std::vector<SubsetOutcome>& outcomes,
                  const Scene& scene) {
  TextTable table;
  table.columns = {"dropped",
                   "views",
                   "placed",
                   "mean_error",
                   "max_error",
                   "worst_view",
                   "mean_error_before_adjustment",
                   "firm",
                   "firm_max_error",
                   "doubtful",
                   "reasons",
                   "failure",
                   "seconds"};
  for (const SubsetOutcome& outcome : outcomes) {
    const std::string dropped = Joined(outcome.dropped, "+", [](ViewId view) {
      return std::to_string(view.value());
    });
    const bool known = HasErrors(outcome);
    const auto error = [&](double value) {
      return known ? Format("%.6f", value) : std::string();
    };
    table.rows.push_back({dropped, std::to_string(outcome.num_views),
                          std::to_string(outcome.num_placed),
                          error(outcome.mean_error), error(outcome.max_error),
                          known ? scene.NameOf(outcome.worst_view) : "",
                          error(outcome.mean_error_before_adjustment),
                          std::to_string(outcome.firm_errors.size()),
                          LargestText(outcome.firm_errors),
                          outcome.doubts.empty() ? "0" : "1",
                          Joined(outcome.doubts, ";"), outcome.failure,
                          Format("%.2f", outcome.seconds)});
  }
  return ToCsv(table);
}

std::string ToJsonLine(const SubsetOutcome& outcome) {
  Json json;
  VisitMembers(outcome, [&](const char* name, const auto& member) {
    json[name] = member;
  });
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

std::optional<SubsetOutcome> SubsetFromJsonLine(const std::string& line) {
  try {
    const Json json = Json::parse(line);
    SubsetOutcome outcome;
    VisitMembers(outcome, [&](const char* name, auto& member) {
      json.at(name).get_to(member);
    });
    return outcome;
  } catch (const Json::exception&) {
    return std::nullopt;
  }
}

std::string ToText(const SubsetSummary& summary, const SubsetBounds& bounds) {
  const std::size_t total = summary.num_subsets;
  const std::string good = Format("%g", bounds.accurate);
  const std::string bad = Format("%g", bounds.failed);
  const auto median = [&](double error) {
    return summary.num_complete > 0 ? Format("%.4f", error) : std::string("-");
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
         std::to_string(summary.num_silent_failures) + "\ncameras within " +
         good + " that are doubted: " +
         Share(summary.num_good_doubted, summary.num_good_cameras) +
         "\ncameras beyond " + bad + ": " +
         std::to_string(summary.num_wrong_cameras) +
         ", named in no warning: " + std::to_string(summary.num_wrong_firm) +
         "\nseconds per subset: " +
         Format("%.2f",
                summary.seconds /
                    static_cast<double>(std::max<std::size_t>(total, 1))) +
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
      {"silent_failures", summary.num_silent_failures},
      {"good_cameras", summary.num_good_cameras},
      {"good_cameras_doubted", summary.num_good_doubted},
      {"wrong_cameras", summary.num_wrong_cameras},
      {"wrong_cameras_firm", summary.num_wrong_firm}};
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
