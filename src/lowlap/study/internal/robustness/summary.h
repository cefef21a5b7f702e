#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "lowlap/report/internal/table_text.h"
#include "lowlap/study/internal/robustness/study.h"

namespace lowlap {

/// A strategy holds where it places at least this share of the views right, in
/// the mean over the seeds.
inline constexpr double kHoldingShare = 0.9;

/// The value that a strategy holds up to (RobustnessScenario::hard_when_small:
/// down to), with every easier one; nullopt if it does not hold anywhere.
std::optional<double> HoldsUpTo(const RobustnessStudy& study,
                                std::size_t scenario, std::size_t strategy);

/// One row per scenario, one column per strategy, and what it holds up to: "-"
/// nowhere, empty if it was not asked at all.
TextTable BreakdownTable(const RobustnessStudy& study);

/// A level where a strategy places more views right than the first one does.
struct BetterStrategy {
  std::size_t scenario = 0;
  std::size_t level = 0;
  std::size_t strategy = 0;  // the best there is
  double right_share = 0;
  double right_share_of_first = 0;
};

/// By at least `least_gap` of the views; the widest gaps first.
std::vector<BetterStrategy> WhereFirstIsWorse(const RobustnessStudy& study,
                                              double least_gap = 0.05);

/// Both, for people.
std::string SummaryText(const RobustnessStudy& study);

}  // namespace lowlap
