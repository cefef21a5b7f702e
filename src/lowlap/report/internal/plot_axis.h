#pragma once

#include <string>
#include <vector>

#include "lowlap/core/result.h"
#include "lowlap/report/internal/svg_plot.h"

namespace lowlap {

/// Where values lie along an axis: 0 at its lower end, 1 at its upper end.
class AxisRange {
 public:
  /// Ends of `axis`, as far as they are not given, at round numbers around the
  /// values that it can show (finite; positive if logarithmic). The errors are
  /// those of DrawBarPlot.
  static Result<AxisRange> Make(const PlotAxis& axis,
                                const std::vector<double>& values);

  /// Whether the axis can show the value at all, within its ends or not.
  bool Shows(double value) const;
  bool Contains(double value) const { return value >= min_ && value <= max_; }
  double Position(double value) const;

  /// Values for labels: 1, 2 or 5 times a power of ten.
  std::vector<double> Ticks() const;

 private:
  AxisRange(AxisScale scale, double min, double max)
      : scale_(scale), min_(min), max_(max) {}

  AxisScale scale_;
  double min_;
  double max_;
};

/// "0.25", "1e+06": six digits at most.
std::string TickLabel(double value);

}  // namespace lowlap
