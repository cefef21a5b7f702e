#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "lowlap/averaging/averager_registry.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/study/internal/robustness/outcome.h"
#include "lowlap/study/internal/robustness/scenarios.h"

namespace lowlap {

struct RobustnessOptions {
  std::vector<std::string> scenarios;  // empty: all
  /// Where strategies come from; register your own there.
  AveragerRegistry registry = AveragerRegistry::WithBuiltIns();
  std::vector<std::string> strategies;  // empty or "all": all
  int num_seeds = 2;                    // simulations per level
  bool quick = false;
  /// A centre is right within this share of the spread of the true centres.
  double tolerance = 0.05;
  /// Processor time that a strategy has for one problem. One that takes longer
  /// is stopped if it asks for leave to go on, else judged when it is done; it
  /// is reported as over time. It is not asked for larger problems of the
  /// scenario that would take longer even if time grew like their size.
  double time_limit_s = 20;

  Status Validate() const;
};

/// One strategy on one simulated problem.
struct RobustnessKey {
  std::size_t scenario = 0;  // index into RobustnessStudy::scenarios
  std::size_t level = 0;
  std::uint64_t seed = 0;
  std::size_t strategy = 0;  // index into RobustnessOptions::strategies
};
bool operator<(const RobustnessKey& a, const RobustnessKey& b);

struct RobustnessStudy {
  RobustnessOptions options;  // with the lists filled in
  std::vector<RobustnessScenario> scenarios;
  std::map<RobustnessKey, RobustnessOutcome> outcomes;
};

/// The study before anything was tried. Errors: invalid options.
Result<RobustnessStudy> PlanRobustnessStudy(const RobustnessOptions& options);

/// Told what is there, from one thread at a time; an error ends the study.
struct RobustnessSinks {
  /// In no fixed order.
  std::function<Status(const RobustnessKey&, const RobustnessOutcome&)> cell;
  /// All cells of the scenario of that index are there; in their order.
  std::function<Status(const RobustnessStudy&, std::size_t)> scenario;
};

/// Fills the outcomes that are missing: every strategy on every level, with the
/// seeds context.seed, context.seed + 1, ... All strategies get the same
/// problem. Cells are shared out over the context's threads; the result is the
/// same for any number of them, but for the seconds and what is over time.
/// Progress is told in cells, with the time left. Errors: those of the sinks,
/// kCancelled; then study->outcomes holds what was done.
Status RunRobustnessStudy(const RunContext& context,
                          const RobustnessSinks& sinks, RobustnessStudy* study);

}  // namespace lowlap
