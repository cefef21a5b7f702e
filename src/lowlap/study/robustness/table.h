#pragma once

#include <cstddef>
#include <string>

#include "lowlap/core/result.h"
#include "lowlap/study/robustness/study.h"

namespace lowlap {

/// One line per strategy and simulation: scenario, world, value, seed,
/// strategy, status, views, placed, right, median_error (empty if infinite),
/// seconds, note.
std::string TrialsCsvHeader();
std::string ToCsvLine(const RobustnessStudy& study, const RobustnessKey& key,
                      const RobustnessOutcome& outcome);
/// The header and the outcomes of the study in their order.
std::string TrialsCsv(const RobustnessStudy& study);

/// Reads outcomes into a study of the same options. A last line without an
/// end, as a study that was killed may leave it, is ignored. kParse, with the
/// line, for anything else that is malformed or not of the study.
Status ParseTrialsCsv(const std::string& text, RobustnessStudy* study);

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
