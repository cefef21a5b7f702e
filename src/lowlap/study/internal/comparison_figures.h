#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "lowlap/study/compare_strategies.h"

namespace lowlap {

/// What tables and plots show of a solution; absent where there is none.
struct Figures {
  std::optional<ErrorStatistics> position, rotation_deg, difference;
  std::optional<ErrorStatistics> direction_deg, log_ratio;
  std::optional<double> rmse_px;
  std::optional<std::size_t> num_points;
};

Figures FiguresBefore(const StrategyResult& result);
Figures FiguresAfter(const StrategyResult& result);
bool IsAdjusted(const Comparison& comparison);

std::optional<double> MeanOf(const std::optional<ErrorStatistics>& errors);
std::optional<double> MedianOf(const std::optional<ErrorStatistics>& errors);
std::optional<double> MaxOf(const std::optional<ErrorStatistics>& errors);

/// The file of the plot of position errors; without a truth it shows
/// differences, and has another name.
std::string PositionPlotName(bool has_truth);

std::optional<double> WallOf(const StrategyResult& result, const char* stage);

}  // namespace lowlap
