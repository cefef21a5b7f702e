#include "lowlap/study/internal/comparison_figures.h"

#include <algorithm>

#include "lowlap/study/internal/study_output.h"

namespace lowlap {
namespace {

Figures FiguresOf(const SolutionQuality& quality) {
  Figures figures;
  if (quality.errors && quality.errors->scope == EvaluationScope::kFull) {
    figures.position = quality.errors->position;
    figures.rotation_deg = quality.errors->rotation_deg;
  }
  figures.difference = quality.difference;
  const Consistency& consistency = quality.consistency;
  if (consistency.direction_deg.count > 0) {
    figures.direction_deg = consistency.direction_deg;
  }
  if (consistency.abs_log_ratio.count > 0) {
    figures.log_ratio = consistency.abs_log_ratio;
  }
  if (consistency.num_points > 0) {
    figures.rmse_px = consistency.reprojection_rmse_px;
  }
  figures.num_points = consistency.num_points;
  return figures;
}

}  // namespace

Figures FiguresBefore(const StrategyResult& result) {
  return result.num_placed > 0 ? FiguresOf(result.before) : Figures{};
}

Figures FiguresAfter(const StrategyResult& result) {
  return result.after ? FiguresOf(*result.after) : Figures{};
}

bool IsAdjusted(const Comparison& comparison) {
  return std::any_of(comparison.results.begin(), comparison.results.end(),
                     [](const auto& result) { return result.after; });
}

std::optional<double> MeanOf(const std::optional<ErrorStatistics>& errors) {
  return errors ? std::optional(errors->mean) : std::nullopt;
}
std::optional<double> MedianOf(const std::optional<ErrorStatistics>& errors) {
  return errors ? std::optional(errors->median) : std::nullopt;
}
std::optional<double> MaxOf(const std::optional<ErrorStatistics>& errors) {
  return errors ? std::optional(errors->max) : std::nullopt;
}

std::optional<double> WallOf(const StrategyResult& result, const char* stage) {
  const StageCost* cost = FindCost(result.costs, stage);
  return cost == nullptr ? std::nullopt : std::optional(cost->wall_s);
}

}  // namespace lowlap
