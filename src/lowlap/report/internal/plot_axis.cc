#include "lowlap/report/internal/plot_axis.h"

#include <algorithm>
#include <cmath>

#include "lowlap/core/internal/format.h"

namespace lowlap {
namespace {

// The least of 1, 2, 5, 10 times a power of ten that is not below `step`.
double RoundUp(double step) {
  const double power = std::pow(10.0, std::floor(std::log10(step)));
  for (const double factor : {1.0, 2.0, 5.0}) {
    if (step <= factor * power * (1 + 1e-9)) return factor * power;
  }
  return 10 * power;
}

double LinearStep(double span) {
  constexpr double kMostTicks = 7;
  return RoundUp(span / kMostTicks);
}

}  // namespace

Result<AxisRange> AxisRange::Make(const PlotAxis& axis,
                                  const std::vector<double>& values) {
  const bool is_log = axis.scale == AxisScale::kLog10;
  for (const std::optional<double>& end : {axis.min, axis.max}) {
    if (end && (!std::isfinite(*end) || (is_log && *end <= 0))) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "plot: an end of the axis '" + axis.label +
                           "' is not a number that it can show");
    }
  }
  std::vector<double> shown;
  for (const double value : values) {
    if (std::isfinite(value) && (!is_log || value > 0)) shown.push_back(value);
  }
  double min = is_log ? 1 : 0;
  double max = is_log ? 10 : 1;
  if (!shown.empty()) {
    const auto [least, most] = std::minmax_element(shown.begin(), shown.end());
    if (is_log) {
      // Something of the shortest bar must be seen.
      constexpr double kRoom = 0.8;
      min = std::pow(10.0, std::floor(std::log10(kRoom * *least)));
      max = std::pow(10.0, std::ceil(std::log10(*most)));
    } else {
      min = std::min(0.0, *least);
      max = std::max(0.0, *most);
      const double step = max > min ? LinearStep(max - min) : 1.0;
      min = step * std::floor(min / step);
      max = step * std::ceil(max / step);
    }
  }
  min = axis.min.value_or(min);
  max = axis.max.value_or(max);
  if (!axis.max && max <= min) max = is_log ? 10 * min : min + 1;
  if (!axis.min && max <= min) min = is_log ? max / 10 : max - 1;
  if (!(min < max)) {
    return MakeError(
        ErrorCode::kInvalidArgument,
        "plot: the ends of the axis '" + axis.label + "' must increase");
  }
  return AxisRange(axis.scale, min, max);
}

bool AxisRange::Shows(double value) const {
  return std::isfinite(value) && (scale_ == AxisScale::kLinear || value > 0);
}

double AxisRange::Position(double value) const {
  if (scale_ == AxisScale::kLinear) return (value - min_) / (max_ - min_);
  return std::log(value / min_) / std::log(max_ / min_);
}

std::vector<double> AxisRange::Ticks() const {
  std::vector<double> ticks;
  if (scale_ == AxisScale::kLinear) {
    const double step = LinearStep(max_ - min_);
    // Adding 0 turns -0 into 0.
    const double first = std::ceil(min_ / step - 1e-9) + 0.0;
    const double last = std::floor(max_ / step + 1e-9);
    for (double n = first; n <= last; ++n) ticks.push_back(n * step);
    return ticks;
  }
  const double decades = std::log10(max_ / min_);
  constexpr double kMostDecades = 8;
  const int stride =
      std::max(1, static_cast<int>(std::ceil(decades / kMostDecades)));
  const int first = static_cast<int>(std::floor(std::log10(min_) + 1e-9));
  const int last = static_cast<int>(std::ceil(std::log10(max_) - 1e-9));
  for (int n = first; n <= last; n += stride) {
    for (const double factor : {1.0, 2.0, 5.0}) {
      if (factor > 1 && decades > 2) continue;
      const double tick = factor * std::pow(10.0, n);
      if (tick >= min_ * (1 - 1e-9) && tick <= max_ * (1 + 1e-9)) {
        ticks.push_back(tick);
      }
    }
  }
  return ticks;
}

std::string TickLabel(double value) { return Format("%.6g", value); }

}  // namespace lowlap
