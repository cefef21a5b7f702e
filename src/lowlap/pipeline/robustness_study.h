#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "lowlap/averaging/translation_problem.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/pipeline/robustness_scenarios.h"

namespace lowlap {

struct RobustnessOptions {
  std::vector<std::string> scenarios;   // empty: all
  std::vector<std::string> strategies;  // empty: all
  int num_seeds = 3;                    // simulations per level
  bool quick = false;
  /// A centre is right within this share of the spread of the true centres
  /// (the root of their mean squared distance from their mean).
  double tolerance = 0.05;
  /// Strategies that solve a program over all edges are not asked for graphs
  /// with more views; ours and the plain chain always are.
  int max_views_of_others = 300;

  Status Validate() const;
};

/// What a strategy made of one simulated problem. Views that are not in its
/// largest component count as not placed.
struct RobustnessOutcome {
  std::string strategy;
  int num_views = 0;
  int num_placed = 0;
  int num_right = 0;  // placed within the tolerance
  /// Of all views, in shares of the spread; infinite if less than half of the
  /// views are placed.
  double median_error = 0;
  /// Why it was not asked, what its error message was, or what it lacks to
  /// place every view; else empty.
  std::string note;
  bool was_asked = false;
};

/// One simulation: a level of a scenario and a seed.
struct RobustnessTrial {
  std::size_t scenario = 0;  // index into RobustnessStudy::scenarios
  std::size_t level = 0;
  std::uint64_t seed = 0;
  std::vector<RobustnessOutcome> outcomes;  // in the order of the strategies
};

struct RobustnessStudy {
  RobustnessOptions options;  // with the lists filled in
  std::vector<RobustnessScenario> scenarios;
  std::vector<RobustnessTrial> trials;  // by scenario, level, seed
};

/// Centres of component 0 against the truth, after the scale and translation
/// of the least median distance, polished: false centres do not move the right
/// ones.
/// `truth` has the views of the problem; of the `num_views` in all, those the
/// problem has not are not placed either. Fills everything but strategy and
/// note.
RobustnessOutcome JudgeCenters(const std::vector<Vec3>& truth, int num_views,
                               const TranslationSolution& solution,
                               const Mat3& truth_from_solved, double tolerance);

/// Every strategy on every trial, each on the same problem. The same for any
/// number of threads. Errors: invalid options, kCancelled.
Result<RobustnessStudy> StudyRobustness(const RobustnessOptions& options,
                                        const RunContext& context);

}  // namespace lowlap
