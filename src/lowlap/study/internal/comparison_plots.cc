#include <algorithm>
#include <utility>

#include "lowlap/study/compare_strategies.h"
#include "lowlap/study/internal/comparison_figures.h"
#include "lowlap/study/internal/study_output.h"

namespace lowlap {
namespace {

/// Bars for all strategies, from up to two values of each.
BarPlot Bars(const Comparison& comparison, std::string title, std::string note,
             std::string axis) {
  BarPlot plot;
  plot.title = std::move(title);
  plot.note = std::move(note);
  plot.value.label = std::move(axis);
  for (const StrategyResult& result : comparison.results) {
    plot.groups.push_back(result.strategy);
  }
  return plot;
}

template <typename Value>
void AddBars(const Comparison& comparison, std::string name, const Value& value,
             BarPlot* plot) {
  BarSeries series;
  series.name = std::move(name);
  for (const StrategyResult& result : comparison.results) {
    series.values.push_back(value(result));
  }
  plot->series.push_back(std::move(series));
}

/// `value(figures)` before adjustment, and after it where there is any.
template <typename Value>
void AddBothBars(const Comparison& comparison, const Value& value,
                 BarPlot* plot) {
  AddBars(
      comparison, "before adjustment",
      [&](const StrategyResult& r) { return value(FiguresBefore(r)); }, plot);
  if (!IsAdjusted(comparison)) return;
  AddBars(
      comparison, "after adjustment",
      [&](const StrategyResult& r) { return value(FiguresAfter(r)); }, plot);
}

// Values of different magnitude are told apart by a logarithmic axis only.
void ChooseScale(BarPlot* plot) {
  constexpr double kWide = 20;
  double least = 0, most = 0;
  for (const BarSeries& series : plot->series) {
    for (const std::optional<double>& value : series.values) {
      if (!value || !(*value > 0)) continue;
      least = least == 0 ? *value : std::min(least, *value);
      most = std::max(most, *value);
    }
  }
  if (most > kWide * least) {
    plot->value.scale = AxisScale::kLog10;
    plot->value.label += ", logarithmic";
  }
}

}  // namespace

std::string PositionPlotName(bool has_truth) {
  return has_truth ? "position_error.svg" : "difference.svg";
}

Result<std::vector<std::pair<std::string, std::string>>> DrawComparison(
    const Comparison& comparison) {
  const bool adjusted = IsAdjusted(comparison);
  const auto figure = [&](const Figures& figures) {
    return MeanOf(comparison.has_truth ? figures.position : figures.difference);
  };
  std::vector<std::pair<std::string, BarPlot>> plots;
  {
    BarPlot plot =
        comparison.has_truth
            ? Bars(comparison, "Position error of the cameras",
                   "Of the cameras that each strategy places, after a "
                   "similarity alignment",
                   "mean error (unit of the true cameras)")
            : Bars(comparison, "Difference to '" + comparison.reference + "'",
                   "Of the cameras that both place, after a similarity "
                   "alignment; it is not an error",
                   "mean difference (mean baselines)");
    AddBothBars(comparison, figure, &plot);
    ChooseScale(&plot);
    plots.emplace_back(PositionPlotName(comparison.has_truth), std::move(plot));
  }
  {
    BarPlot plot = Bars(comparison, "Cameras placed",
                        "With one common scale; what is not placed is said, "
                        "not guessed",
                        "cameras of " + std::to_string(comparison.num_views));
    plot.value.min = 0;
    plot.value.max = std::max(1, comparison.num_views);
    AddBars(
        comparison, "cameras",
        [](const StrategyResult& r) {
          return std::optional<double>(r.num_placed);
        },
        &plot);
    plots.emplace_back("cameras_placed.svg", std::move(plot));
  }
  {
    BarPlot plot = Bars(comparison, "Disagreement with the relative poses",
                        "Median over the relative poses between cameras "
                        "placed; needs no true cameras",
                        "direction of the baseline (degrees)");
    AddBothBars(
        comparison,
        [](const Figures& figures) { return MedianOf(figures.direction_deg); },
        &plot);
    ChooseScale(&plot);
    plots.emplace_back("direction_error.svg", std::move(plot));
  }
  {
    BarPlot plot = Bars(comparison, "Time", "Wall clock", "seconds");
    AddBars(
        comparison, "averaging",
        [](const StrategyResult& r) { return WallOf(r, "averaging"); }, &plot);
    if (adjusted) {
      AddBars(
          comparison, "adjustment",
          [](const StrategyResult& r) { return WallOf(r, "adjustment"); },
          &plot);
    }
    ChooseScale(&plot);
    plots.emplace_back("time.svg", std::move(plot));
  }
  return DrawBarPlots(plots);
}

}  // namespace lowlap
