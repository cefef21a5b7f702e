#pragma once

#include <cstddef>
#include <string>

#include "lowlap/study/internal/robustness/study.h"

namespace lowlap {

/// One record per strategy and simulation: scenario, world, value, seed,
/// strategy, status, views, placed, right, median_error (empty if infinite),
/// seconds, note.
std::string TrialsCsv(const RobustnessStudy& study);

/// A record of a ResultLog.
std::string ToJsonLine(const RobustnessStudy& study, const RobustnessKey& key,
                       const RobustnessOutcome& outcome);
/// The inverse: adds the outcome to a study of the same options; false, and
/// nothing is added, for anything else.
bool AddJsonLine(const std::string& line, RobustnessStudy* study);

/// A strategy at a level, over the seeds.
struct CurvePoint {
  /// Solved or failed with every seed: there is something to draw.
  bool is_known = false;
  double placed_share = 0;  // mean
  double right_share = 0;   // mean
  double median_error = 0;  // median of the median errors
  double seconds = 0;       // median
  std::string note;         // the first there is
};

CurvePoint PointOf(const RobustnessStudy& study, std::size_t scenario,
                   std::size_t level, std::size_t strategy);

/// One line per scenario, value and strategy that has outcomes: scenario,
/// world, value, strategy, and the numbers of its CurvePoint; empty where
/// nothing is known, or infinite.
std::string CurvesCsv(const RobustnessStudy& study);

}  // namespace lowlap
