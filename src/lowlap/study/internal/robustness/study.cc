#include "lowlap/study/internal/robustness/study.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <mutex>
#include <optional>
#include <set>
#include <tuple>
#include <utility>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/study/internal/robustness/problem.h"

namespace lowlap {
namespace {

using Clock = std::chrono::steady_clock;

// Of the calling thread, so that a busy machine makes nothing slower.
double ThreadCpuSeconds() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) +
         1e-9 * static_cast<double>(time.tv_nsec);
}

std::string Decimals(double value, int count) {
  char text[32];
  std::snprintf(text, sizeof text, "%.*f", count, value);
  return text;
}

RobustnessOutcome Missing(RobustnessStatus status, int num_views,
                          std::string note) {
  RobustnessOutcome outcome;
  outcome.status = status;
  outcome.num_views = num_views;
  outcome.median_error = HUGE_VAL;
  outcome.note = std::move(note);
  return outcome;
}

void DropRepetitions(std::vector<std::string>* names) {
  std::vector<std::string> kept;
  for (const std::string& name : *names) {
    if (std::find(kept.begin(), kept.end(), name) == kept.end()) {
      kept.push_back(name);
    }
  }
  *names = std::move(kept);
}

/// The work of one start: what is missing, and how much of it is done.
class StudyRun {
 public:
  StudyRun(const RunContext& context, const RobustnessSinks& sinks,
           RobustnessStudy* study)
      : context_(context), sinks_(sinks), study_(study) {
    for (std::size_t s = 0; s < study_->scenarios.size(); ++s) {
      for (const RobustnessKey& key : MissingCells(s)) {
        ++num_cells_;
        work_left_ += WorkOf(key);
      }
    }
    work_ = work_left_;
  }

  Status RunScenario(std::size_t scenario) {
    const std::vector<RobustnessKey> missing = MissingCells(scenario);
    if (!missing.empty()) {
      LOWLAP_RETURN_IF_ERROR(SimulateProblems(missing));
    }
    // Where levels differ in size, what a level shows decides who is asked for
    // the next.
    const RobustnessScenario& info = study_->scenarios[scenario];
    for (auto begin = missing.begin(); begin != missing.end();) {
      const std::size_t level = begin->level;
      const auto end =
          !info.levels_grow
              ? missing.end()
              : std::find_if(begin, missing.end(), [&](const auto& key) {
                  return key.level != level;
                });
      LOWLAP_RETURN_IF_ERROR(TryCells({begin, end}));
      begin = end;
    }
    problems_.clear();
    return sinks_.scenario ? sinks_.scenario(*study_, scenario) : Status();
  }

 private:
  using Trial = std::tuple<std::size_t, std::size_t, std::uint64_t>;

  const RobustnessLevel& LevelOf(const RobustnessKey& key) const {
    return study_->scenarios[key.scenario].levels[key.level];
  }
  // About how long a cell takes, in no unit.
  double WorkOf(const RobustnessKey& key) const {
    const RobustnessLevel& level = LevelOf(key);
    return level.scene.num_views * (level.has_features ? 5.0 : 1.0);
  }

  std::vector<RobustnessKey> MissingCells(std::size_t scenario) const {
    std::vector<RobustnessKey> cells;
    RobustnessKey key;
    key.scenario = scenario;
    const std::size_t num_levels = study_->scenarios[scenario].levels.size();
    for (key.level = 0; key.level < num_levels; ++key.level) {
      for (int n = 0; n < study_->options.num_seeds; ++n) {
        key.seed = context_.seed + static_cast<std::uint64_t>(n);
        for (key.strategy = 0; key.strategy < study_->options.strategies.size();
             ++key.strategy) {
          if (study_->outcomes.count(key) == 0) cells.push_back(key);
        }
      }
    }
    return cells;
  }

  // Progress under another name, in cells of the whole study.
  RunContext Watched(const std::string& what) {
    RunContext watched = context_;
    watched.progress = [this, what](const std::string&, std::size_t,
                                    std::size_t) {
      const std::lock_guard<std::mutex> lock(mutex_);
      stopped_ = stopped_ ||
                 !context_.Progress(what + TimeLeft(), num_done_, num_cells_);
      return !stopped_ && failed_.has_value();
    };
    return watched;
  }

  std::string TimeLeft() const {
    const double seconds =
        std::chrono::duration<double>(Clock::now() - start_).count();
    if (seconds < 5 || work_left_ >= work_) return ":";
    const double left = seconds * work_left_ / (work_ - work_left_);
    if (left < 90) return ", about " + Decimals(left, 0) + " s left:";
    return ", about " + Decimals(left / 60, 0) + " min left:";
  }

  Status SimulateProblems(const std::vector<RobustnessKey>& missing) {
    std::set<Trial> wanted;
    for (const RobustnessKey& key : missing) {
      wanted.emplace(key.scenario, key.level, key.seed);
    }
    for (const Trial& trial : wanted) problems_.emplace(trial, std::nullopt);
    std::vector<std::pair<const Trial, Problem>*> slots;
    for (auto& entry : problems_) slots.push_back(&entry);
    const std::string& name = study_->scenarios[missing.front().scenario].Id();
    // The largest come last: begin with them.
    return ParallelFor(Watched("simulating " + name), "simulating",
                       slots.size(), [&](std::size_t n) {
                         auto& [trial, problem] = *slots[slots.size() - 1 - n];
                         const auto& [scenario, level, seed] = trial;
                         RunContext alone;
                         alone.num_threads = 1;
                         alone.seed = seed;
                         problem = SimulateProblem(
                             study_->scenarios[scenario].levels[level], seed,
                             alone);
                       });
  }

  Status TryCells(const std::vector<RobustnessKey>& cells) {
    const Status tried = ParallelFor(
        Watched(study_->scenarios[cells.front().scenario].Id()), "trying",
        cells.size(), [&](std::size_t n) {
          const std::optional<RobustnessOutcome> outcome = Try(cells[n]);
          const std::lock_guard<std::mutex> lock(mutex_);
          if (!outcome || !failed_) return;
          study_->outcomes[cells[n]] = *outcome;
          ++num_done_;
          work_left_ -= WorkOf(cells[n]);
          if (sinks_.cell) failed_ = sinks_.cell(cells[n], *outcome);
        });
    return failed_ ? tried : failed_;
  }

  // A smaller problem of the scenario took the strategy so long that this one
  // would be over time even if time only grew like the number of views.
  bool WouldBeOverTime(const RobustnessKey& key) {
    if (!study_->scenarios[key.scenario].levels_grow) return false;
    const auto seconds_here = [&](const RobustnessKey& smaller,
                                  double seconds) {
      return seconds * LevelOf(key).scene.num_views /
             LevelOf(smaller).scene.num_views;
    };
    const std::lock_guard<std::mutex> lock(mutex_);
    return std::any_of(
        study_->outcomes.begin(), study_->outcomes.end(),
        [&](const auto& entry) {
          const auto& [other, outcome] = entry;
          return other.scenario == key.scenario && other.level < key.level &&
                 other.strategy == key.strategy &&
                 (outcome.status == RobustnessStatus::kOverTime ||
                  seconds_here(other, outcome.seconds) >
                      study_->options.time_limit_s);
        });
  }

  // Nothing if the study is to stop.
  std::optional<RobustnessOutcome> Try(const RobustnessKey& key) {
    const RobustnessOptions& options = study_->options;
    const RobustnessLevel& level = LevelOf(key);
    const int num_views = level.scene.num_views;
    const auto averager =
        options.registry.Make(options.strategies[key.strategy]);
    if (!averager) {
      return Missing(RobustnessStatus::kFailed, num_views,
                     averager.error().message);
    }
    if ((*averager)->NeedsTracks() && !level.HasTracks()) {
      return Missing(RobustnessStatus::kNotAsked, num_views,
                     "needs point tracks");
    }
    if (WouldBeOverTime(key)) {
      return Missing(RobustnessStatus::kNotAsked, num_views,
                     "would take more than " +
                         Decimals(options.time_limit_s, 1) +
                         " s, judging by a smaller problem");
    }
    const Problem& problem = problems_.at({key.scenario, key.level, key.seed});
    if (!*problem) {
      return Missing(RobustnessStatus::kFailed, num_views,
                     problem->error().message);
    }
    const SimulatedProblem& made = **problem;
    const double start = ThreadCpuSeconds();
    RunContext alone;
    alone.num_threads = 1;
    alone.seed = key.seed;
    alone.progress = [&](const std::string&, std::size_t, std::size_t) {
      const std::lock_guard<std::mutex> lock(mutex_);
      return !stopped_ && ThreadCpuSeconds() - start < options.time_limit_s;
    };
    const auto solution = (*averager)->Solve(made.problem, alone);
    const double seconds = ThreadCpuSeconds() - start;
    RobustnessOutcome outcome;
    if (seconds >= options.time_limit_s) {
      outcome =
          Missing(RobustnessStatus::kOverTime, num_views,
                  "took more than " + Decimals(options.time_limit_s, 1) + " s");
    } else if (!solution) {
      if (solution.error().code == ErrorCode::kCancelled) return std::nullopt;
      outcome = Missing(RobustnessStatus::kFailed, num_views,
                        solution.error().message);
    } else {
      outcome = JudgeCenters(made.true_centers, num_views, *solution,
                             made.truth_from_solved, options.tolerance);
      if (outcome.num_placed < num_views) {
        outcome.note = "a view needs " + (*averager)->Needs();
      }
    }
    outcome.seconds = seconds;
    return outcome;
  }

  using Problem = std::optional<Result<SimulatedProblem>>;

  const RunContext& context_;
  const RobustnessSinks& sinks_;
  RobustnessStudy* study_;
  std::map<Trial, Problem> problems_;
  const Clock::time_point start_ = Clock::now();

  std::mutex mutex_;  // of what follows, and of study_->outcomes
  Status failed_;
  bool stopped_ = false;
  std::size_t num_cells_ = 0, num_done_ = 0;
  double work_ = 0, work_left_ = 0;
};

}  // namespace

bool operator<(const RobustnessKey& a, const RobustnessKey& b) {
  return std::tie(a.scenario, a.level, a.seed, a.strategy) <
         std::tie(b.scenario, b.level, b.seed, b.strategy);
}

Status RobustnessOptions::Validate() const {
  const auto invalid = [](const std::string& message) {
    return MakeError(ErrorCode::kInvalidArgument, "robustness: " + message);
  };
  if (num_seeds < 1) return invalid("the number of seeds must be positive");
  if (!(tolerance > 0)) return invalid("the tolerance must be positive");
  if (!(time_limit_s > 0)) return invalid("the time limit must be positive");
  for (const std::string& name : scenarios) {
    LOWLAP_RETURN_IF_ERROR(MakeRobustnessScenarios(name, quick));
  }
  for (const std::string& name : registry.Expand(strategies)) {
    LOWLAP_RETURN_IF_ERROR(registry.Make(name));
  }
  return {};
}

Result<RobustnessStudy> PlanRobustnessStudy(const RobustnessOptions& options) {
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  RobustnessStudy study;
  study.options = options;
  if (options.scenarios.empty()) {
    study.options.scenarios = RobustnessScenarioNames();
  }
  study.options.strategies = options.strategies.empty()
                                 ? options.registry.Names()
                                 : options.registry.Expand(options.strategies);
  DropRepetitions(&study.options.scenarios);
  for (const std::string& name : study.options.scenarios) {
    LOWLAP_ASSIGN_OR_RETURN(auto scenarios,
                            MakeRobustnessScenarios(name, options.quick));
    for (RobustnessScenario& each : scenarios) {
      study.scenarios.push_back(std::move(each));
    }
  }
  return study;
}

Status RunRobustnessStudy(const RunContext& context,
                          const RobustnessSinks& sinks,
                          RobustnessStudy* study) {
  StudyRun run(context, sinks, study);
  for (std::size_t s = 0; s < study->scenarios.size(); ++s) {
    LOWLAP_RETURN_IF_ERROR(run.RunScenario(s));
  }
  return {};
}

}  // namespace lowlap
