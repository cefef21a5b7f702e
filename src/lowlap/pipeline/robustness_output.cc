#include "lowlap/pipeline/robustness_output.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <utility>
#include <vector>

#include "lowlap/core/median.h"
#include "lowlap/pipeline/output_folder.h"
#include "lowlap/report/svg_plot.h"

namespace lowlap {
namespace {

std::string Number(double value) {
  if (!std::isfinite(value)) return "";
  char text[32];
  std::snprintf(text, sizeof(text), "%.6g", value);
  return text;
}

std::string Quoted(const std::string& text) {
  std::string quoted = "\"";
  for (const char c : text) {
    quoted += c;
    if (c == '"') quoted += c;
  }
  return quoted + "\"";
}

/// A strategy at a level, over the seeds.
struct CurvePoint {
  double placed_share = 0;
  double right_share = 0;
  double median_error = 0;
  bool is_asked = false;
  std::string note;
};

CurvePoint Summarize(const RobustnessStudy& study, std::size_t scenario,
                     std::size_t level, std::size_t strategy) {
  CurvePoint point;
  std::vector<double> errors;
  for (const RobustnessTrial& trial : study.trials) {
    if (trial.scenario != scenario || trial.level != level) continue;
    const RobustnessOutcome& outcome = trial.outcomes[strategy];
    point.placed_share +=
        static_cast<double>(outcome.num_placed) / outcome.num_views;
    point.right_share +=
        static_cast<double>(outcome.num_right) / outcome.num_views;
    errors.push_back(outcome.median_error);
    if (point.note.empty()) point.note = outcome.note;
    if (outcome.was_asked) point.is_asked = true;
  }
  const auto count = static_cast<double>(errors.size());
  point.placed_share /= count;
  point.right_share /= count;
  point.median_error = Median(std::move(errors));
  return point;
}

template <class Value>
Result<std::string> DrawCurves(const RobustnessStudy& study, std::size_t s,
                               PlotAxis y, const Value& value) {
  const RobustnessScenario& scenario = study.scenarios[s];
  LinePlot plot;
  plot.title = scenario.name + ", " + scenario.world;
  plot.note = std::to_string(study.options.num_seeds) +
              " simulations per value; right: within " +
              Number(study.options.tolerance) + " of the centres' spread";
  plot.x.label = scenario.axis;
  plot.x.scale =
      scenario.is_logarithmic ? AxisScale::kLog10 : AxisScale::kLinear;
  plot.y = std::move(y);
  for (std::size_t n = 0; n < study.options.strategies.size(); ++n) {
    LineSeries series;
    series.name = study.options.strategies[n];
    bool any = false;
    for (std::size_t l = 0; l < scenario.levels.size(); ++l) {
      const CurvePoint point = Summarize(study, s, l, n);
      any = any || point.is_asked;
      series.points.emplace_back(scenario.levels[l].value,
                                 point.is_asked ? value(point) : HUGE_VAL);
    }
    if (any) plot.series.push_back(std::move(series));
  }
  return DrawLinePlot(plot);
}

}  // namespace

std::string TrialsCsv(const RobustnessStudy& study) {
  std::string csv =
      "scenario,world,value,seed,strategy,views,placed,right,median_error,"
      "note\n";
  for (const RobustnessTrial& trial : study.trials) {
    const RobustnessScenario& scenario = study.scenarios[trial.scenario];
    for (const RobustnessOutcome& outcome : trial.outcomes) {
      csv += scenario.name + "," + scenario.world + "," +
             Number(scenario.levels[trial.level].value) + "," +
             std::to_string(trial.seed) + "," + outcome.strategy + "," +
             std::to_string(outcome.num_views) + "," +
             std::to_string(outcome.num_placed) + "," +
             std::to_string(outcome.num_right) + "," +
             Number(outcome.median_error) + "," + Quoted(outcome.note) + "\n";
    }
  }
  return csv;
}

std::string CurvesCsv(const RobustnessStudy& study) {
  std::string csv =
      "scenario,world,value,strategy,placed_share,right_share,median_error,"
      "note\n";
  for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
    const RobustnessScenario& scenario = study.scenarios[s];
    for (std::size_t l = 0; l < scenario.levels.size(); ++l) {
      for (std::size_t n = 0; n < study.options.strategies.size(); ++n) {
        const CurvePoint point = Summarize(study, s, l, n);
        csv += scenario.name + "," + scenario.world + "," +
               Number(scenario.levels[l].value) + "," +
               study.options.strategies[n] + ",";
        if (point.is_asked) {
          csv += Number(point.placed_share) + "," + Number(point.right_share) +
                 "," + Number(point.median_error);
        } else {
          csv += ",,";
        }
        csv += "," + Quoted(point.note) + "\n";
      }
    }
  }
  return csv;
}

Status WriteRobustness(const RobustnessStudy& study,
                       const std::string& folder) {
  std::vector<std::pair<std::string, std::string>> files = {
      {"trials.csv", TrialsCsv(study)}, {"curves.csv", CurvesCsv(study)}};
  PlotAxis share;
  share.label = "share of views placed right";
  share.min = 0;
  share.max = 1;
  PlotAxis error;
  error.label = "median position error / spread of the centres";
  error.scale = AxisScale::kLog10;
  for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
    auto right = DrawCurves(study, s, share, [](const CurvePoint& point) {
      return point.right_share;
    });
    if (!right) return tl::unexpected<Error>(right.error());
    auto wrong = DrawCurves(study, s, error, [](const CurvePoint& point) {
      return point.median_error;
    });
    if (!wrong) return tl::unexpected<Error>(wrong.error());
    files.emplace_back(study.scenarios[s].Id() + "_right.svg",
                       std::move(*right));
    files.emplace_back(study.scenarios[s].Id() + "_error.svg",
                       std::move(*wrong));
  }
  return WriteTextFiles(files, folder);
}

}  // namespace lowlap
