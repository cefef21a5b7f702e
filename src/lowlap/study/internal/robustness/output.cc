#include "lowlap/study/internal/robustness/output.h"

#include <cmath>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/output_folder.h"
#include "lowlap/report/internal/svg_plot.h"
#include "lowlap/report/internal/table_text.h"
#include "lowlap/study/internal/robustness/summary.h"
#include "lowlap/study/internal/robustness/table.h"

namespace lowlap {
namespace {

using Files = std::vector<std::pair<std::string, std::string>>;

struct Quantity {
  const char* file;
  PlotAxis axis;
  double CurvePoint::*value;
};

std::vector<Quantity> QuantitiesOf(const RobustnessScenario& scenario) {
  Quantity right{"right", {}, &CurvePoint::right_share};
  right.axis.label = "share of views placed right";
  right.axis.min = 0;
  right.axis.max = 1;
  Quantity error{"error", {}, &CurvePoint::median_error};
  error.axis.label = "median position error / spread of the centres";
  error.axis.scale = AxisScale::kLog10;
  std::vector<Quantity> quantities = {right, error};
  if (scenario.levels_grow) {
    Quantity time{"time", {}, &CurvePoint::seconds};
    time.axis.label = "processor time (s)";
    time.axis.scale = AxisScale::kLog10;
    quantities.push_back(time);
  }
  return quantities;
}

Result<std::string> Draw(const RobustnessStudy& study, std::size_t s,
                         const Quantity& quantity) {
  const RobustnessScenario& scenario = study.scenarios[s];
  LinePlot plot;
  plot.title = scenario.name + ", " + scenario.world;
  plot.note = std::to_string(study.options.num_seeds) +
              " simulations per value; right: within " +
              NumberText(study.options.tolerance, 6) +
              " of the centres' spread";
  plot.x.label = scenario.axis;
  plot.x.scale =
      scenario.is_logarithmic ? AxisScale::kLog10 : AxisScale::kLinear;
  if (scenario.levels.size() > 1) {
    plot.x.min = scenario.levels.front().value;
    plot.x.max = scenario.levels.back().value;
  }
  plot.y = quantity.axis;
  for (std::size_t n = 0; n < study.options.strategies.size(); ++n) {
    LineSeries series;
    series.name = study.options.strategies[n];
    for (std::size_t l = 0; l < scenario.levels.size(); ++l) {
      const CurvePoint point = PointOf(study, s, l, n);
      series.points.emplace_back(
          scenario.levels[l].value,
          point.is_known ? point.*quantity.value : HUGE_VAL);
    }
    plot.series.push_back(std::move(series));
  }
  return DrawLinePlot(plot);
}

std::string PlotName(const RobustnessScenario& scenario,
                     const Quantity& quantity) {
  return scenario.Id() + "_" + quantity.file + ".svg";
}

std::string HtmlTable(const TextTable& table) {
  std::string html = "<table>\n<tr>";
  for (const std::string& name : table.columns) html += "<th>" + name + "</th>";
  html += "</tr>\n";
  for (const std::vector<std::string>& row : table.rows) {
    html += "<tr>";
    for (const std::string& cell : row) html += "<td>" + cell + "</td>";
    html += "</tr>\n";
  }
  return html + "</table>\n";
}

}  // namespace

Result<Files> DrawScenario(const RobustnessStudy& study, std::size_t scenario) {
  Files files;
  const RobustnessScenario& info = study.scenarios[scenario];
  for (const Quantity& quantity : QuantitiesOf(info)) {
    LOWLAP_ASSIGN_OR_RETURN(auto drawn, Draw(study, scenario, quantity));
    files.emplace_back(PlotName(info, quantity), std::move(drawn));
  }
  return files;
}

std::string IndexHtml(const RobustnessStudy& study) {
  std::string html =
      "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
      "<title>Robustness of translation averaging</title>\n"
      "<style>\nbody { font-family: system-ui, sans-serif; margin: 2em; "
      "color: #1d2733; }\n"
      "img { width: 48%; min-width: 560px; }\n"
      "table { border-collapse: collapse; font-size: 13px; }\n"
      "th, td { border: 1px solid #dfe4ea; padding: 3px 7px; text-align: "
      "right; }\n"
      "td:first-child, th:first-child { text-align: left; }\n"
      "</style>\n</head>\n<body>\n"
      "<h1>Robustness of translation averaging</h1>\n"
      "<p>At least " +
      NumberText(100 * kHoldingShare, 3) +
      " % of the views are placed right up to (<code>line</code>, "
      "<code>twins</code>: down to) these values; a dash: nowhere; nothing: "
      "not asked.</p>\n" +
      HtmlTable(BreakdownTable(study)) +
      "<p>Numbers: <a href=\"curves.csv\">curves.csv</a>, <a "
      "href=\"trials.csv\">trials.csv</a>, <a "
      "href=\"summary.txt\">summary.txt</a>.</p>\n";
  for (const RobustnessScenario& scenario : study.scenarios) {
    html += "<h2 id=\"" + scenario.Id() + "\">" + scenario.name + ", " +
            scenario.world + "</h2>\n<p>Against: " + scenario.axis + "</p>\n";
    for (const Quantity& quantity : QuantitiesOf(scenario)) {
      const std::string name = PlotName(scenario, quantity);
      html.append("<a href=\"").append(name).append("\"><img src=\"");
      html.append(name).append("\" alt=\"").append(quantity.axis.label);
      html += "\"></a>\n";
    }
  }
  return html + "</body>\n</html>\n";
}

Status WriteRobustness(const RobustnessStudy& study,
                       const std::string& folder) {
  Files files = {{"trials.csv", TrialsCsv(study)},
                 {"curves.csv", CurvesCsv(study)},
                 {"summary.txt", SummaryText(study)},
                 {"index.html", IndexHtml(study)}};
  for (std::size_t s = 0; s < study.scenarios.size(); ++s) {
    LOWLAP_ASSIGN_OR_RETURN(auto plots, DrawScenario(study, s));
    for (auto& plot : plots) files.push_back(std::move(plot));
  }
  return WriteTextFiles(files, folder);
}

}  // namespace lowlap
