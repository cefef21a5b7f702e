#pragma once

#include <string>
#include <vector>

#include "lowlap/averaging/translation_problem.h"

namespace lowlap {

enum class RobustnessStatus {
  kSolved,
  kFailed,    // it returned an error, or the problem could not be made
  kOverTime,  // it took more than RobustnessOptions::time_limit_s
  kNotAsked,  // it lacks its input, or the problem is too large for it
};

/// "solved", "failed", "time", "not asked".
const char* RobustnessStatusName(RobustnessStatus status);

/// What a strategy made of one simulated problem. Views that are not in its
/// largest component count as not placed.
struct RobustnessOutcome {
  RobustnessStatus status = RobustnessStatus::kNotAsked;
  int num_views = 0;
  int num_placed = 0;
  int num_right = 0;  // placed within the tolerance
  /// Of all views, in shares of the spread; infinite if less than half of the
  /// views are placed.
  double median_error = 0;
  double seconds = 0;  // of processor time, on one thread
  /// Why it was not asked, what its error message was, or what it lacks to
  /// place every view; else empty.
  std::string note;
};

/// Centres of component 0 against the truth, after the scale and translation
/// of the least median distance, polished: false centres do not move the right
/// ones. `truth` has the views of the problem; of the `num_views` in all, those
/// the problem has not are not placed either. A centre is right within
/// `tolerance` times the spread of the true centres, the root of their mean
/// squared distance from their mean. Fills the numbers; the status is kSolved.
RobustnessOutcome JudgeCenters(const std::vector<Vec3>& truth, int num_views,
                               const TranslationSolution& solution,
                               const Mat3& truth_from_solved, double tolerance);

}  // namespace lowlap
