#pragma once

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/result.h"

namespace lowlap {

enum class AxisScale { kLinear, kLog10 };

/// An axis with its label, which names quantity and unit: "position error (m)".
struct PlotAxis {
  std::string label;
  AxisScale scale = AxisScale::kLinear;
  /// Ends of the axis; chosen from the data (and, of linear axes, 0) if absent.
  std::optional<double> min;
  std::optional<double> max;
};

/// The bars of one colour, one for each group. Absent values have no bar but a
/// dash.
struct BarSeries {
  std::string name;  // in the legend
  std::vector<std::optional<double>> values;
};

/// Horizontal bars in groups from top to bottom, so that long names of groups
/// can be read.
struct BarPlot {
  std::string title;
  std::string note;  // below the title; may be empty
  PlotAxis value;
  std::vector<std::string> groups;
  std::vector<BarSeries> series;
};

/// One curve: points (x, y) joined in their order. A point with a coordinate
/// that is not finite, or not positive on a logarithmic axis, is a gap.
struct LineSeries {
  std::string name;  // in the legend
  std::vector<std::pair<double, double>> points;
};

/// Curves over a common horizontal axis, each with a colour, a dash and a
/// marker of its own, by its place among the series. The first lie on top.
/// Series without any value have no entry in the legend.
struct LinePlot {
  std::string title;
  std::string note;  // below the title; may be empty
  PlotAxis x;
  PlotAxis y;
  std::vector<LineSeries> series;
};

/// The plots as SVG documents of their own (no script, no outside resource),
/// with axes, ticks at round numbers, grid and legend. Texts are escaped. The
/// same plot gives the same bytes.
///
/// Degenerate: without any value to draw the axes span [0, 1] (logarithmic:
/// [1, 10]). Values beyond given ends of an axis are cut off there (bars) or
/// not drawn (curves).
///
/// Errors: kInvalidArgument if a series of bars does not have one value for
/// each group, or given ends of an axis are not increasing (not positive, on a
/// logarithmic axis).
Result<std::string> DrawBarPlot(const BarPlot& plot);
Result<std::string> DrawLinePlot(const LinePlot& plot);

}  // namespace lowlap
