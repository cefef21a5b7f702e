#include <chrono>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <memory>

#include "cli/command.h"
#include "cli/flags/solve_flags.h"
#include "lowlap/core/internal/joined.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/output_folder.h"
#include "lowlap/report/internal/table_text.h"
#include "lowlap/study/internal/look_alikes/study.h"
#include "lowlap/study/internal/look_alikes/trial_json.h"
#include "lowlap/study/internal/result_log.h"
#include "lowlap/study/internal/robustness/output.h"
#include "lowlap/study/internal/robustness/study.h"
#include "lowlap/study/internal/robustness/summary.h"
#include "lowlap/study/internal/robustness/table.h"
#include "lowlap/study/internal/trust/study.h"
#include "lowlap/study/internal/trust/summary.h"
#include "lowlap/study/internal/trust/table.h"

namespace lowlap::cli {
namespace {

struct RobustnessFlags {
  CommonFlags common;
  RobustnessOptions options;
  bool trust = false;
  int num_scenes = TrustStudy().num_scenes;
  bool look_alikes = false;
  int num_pairs = LookAlikeStudy().num_pairs;
  std::string output;
};

// The trials of an output folder; `take` is given those that are there.
Result<ResultLog> OpenTrials(
    const RobustnessFlags& flags, const std::string& settings,
    const std::function<bool(const std::string&)>& take) {
  OutputFolder folder;
  LOWLAP_RETURN_IF_ERROR(folder.Make(flags.output));
  return ResultLog::Open(
      (std::filesystem::path(flags.output) / "trials.jsonl").string(), settings,
      take);
}

void TellTrials(std::size_t count, const RunContext& context) {
  if (count == 0) return;
  context.Log(LogLevel::kInfo,
              std::to_string(count) + " trials are in trials.jsonl already");
}

// What the trials depend on.
std::string SettingsText(const RobustnessOptions& options, std::uint64_t seed) {
  return "version " LOWLAP_VERSION "\nscenarios " +
         Joined(options.scenarios, ", ") + (options.quick ? ", quick" : "") +
         "\nstrategies " + Joined(options.strategies, ", ") + "\nseeds " +
         std::to_string(options.num_seeds) + " from " + std::to_string(seed) +
         "\ntolerance " + NumberText(options.tolerance, 9) + "\ntime limit " +
         NumberText(options.time_limit_s, 9) + "\n";
}

Status Complete(const RobustnessFlags& flags, const RunContext& context,
                RobustnessStudy* study) {
  const auto log = OpenTrials(
      flags, SettingsText(study->options, flags.common.seed),
      [&](const std::string& record) { return AddJsonLine(record, study); });
  if (!log) return tl::unexpected<Error>(log.error());
  TellTrials(study->outcomes.size(), context);
  const auto start = std::chrono::steady_clock::now();
  RobustnessSinks sinks;
  sinks.cell = [&](const RobustnessKey& key, const RobustnessOutcome& outcome) {
    return log->Append(ToJsonLine(*study, key, outcome));
  };
  sinks.scenario = [&](const RobustnessStudy& so_far,
                       std::size_t scenario) -> Status {
    LOWLAP_ASSIGN_OR_RETURN(const auto plots, DrawScenario(so_far, scenario));
    const std::chrono::duration<double> elapsed =
        std::chrono::steady_clock::now() - start;
    context.Log(LogLevel::kInfo,
                so_far.scenarios[scenario].Id() + " is complete (" +
                    std::to_string(scenario + 1) + " of " +
                    std::to_string(so_far.scenarios.size()) + ", " +
                    NumberText(std::round(elapsed.count()), 6) + " s)");
    return WriteTextFiles(plots, flags.output);
  };
  return RunRobustnessStudy(context, sinks, study);
}

Result<int> StudyTrust(const RobustnessFlags& flags) {
  TrustStudy study;
  study.num_scenes = flags.num_scenes;
  const RunContext context = MakeContext(flags.common);
  const auto log = OpenTrials(
      flags,
      "version " LOWLAP_VERSION "\ntrust, scenes " +
          std::to_string(study.num_scenes) + " from " +
          std::to_string(flags.common.seed) + "\n",
      [&](const std::string& record) { return AddJsonLine(record, &study); });
  if (!log) return tl::unexpected<Error>(log.error());
  TellTrials(study.trials.size(), context);
  LOWLAP_RETURN_IF_ERROR(RunTrustStudy(
      context,
      [&](const TrustKey& key, const TrustTrial& trial) {
        return log->Append(ToJsonLine(key, trial));
      },
      &study));
  LOWLAP_ASSIGN_OR_RETURN(const auto files, TrustFiles(study));
  LOWLAP_RETURN_IF_ERROR(WriteTextFiles(files, flags.output));
  std::printf("%s\nwritten to %s: summary.txt cameras.csv firm_share.svg\n",
              SummaryText(study).c_str(), flags.output.c_str());
  return 0;
}

Result<int> StudyLookAlikes(const RobustnessFlags& flags) {
  LookAlikeStudy study;
  study.num_pairs = flags.num_pairs;
  const RunContext context = MakeContext(flags.common);
  const auto log = OpenTrials(
      flags,
      "version " LOWLAP_VERSION "\nlook-alikes, pairs " +
          std::to_string(study.num_pairs) + " from " +
          std::to_string(flags.common.seed) + "\n",
      [&](const std::string& record) { return AddJsonLine(record, &study); });
  if (!log) return tl::unexpected<Error>(log.error());
  TellTrials(study.trials.size(), context);
  LOWLAP_RETURN_IF_ERROR(RunLookAlikeStudy(
      context,
      [&](const LookAlikeKey& key, const LookAlikeTrial& trial) {
        return log->Append(ToJsonLine(key, trial));
      },
      &study));
  LOWLAP_RETURN_IF_ERROR(WriteTextFiles(LookAlikeFiles(study), flags.output));
  std::printf("%s\nwritten to %s: summary.txt pairs.csv\n",
              ToAlignedText(LookAlikeTable(study)).c_str(),
              flags.output.c_str());
  return 0;
}

Result<int> StudyAndWrite(const RobustnessFlags& flags) {
  if (flags.trust) return StudyTrust(flags);
  if (flags.look_alikes) return StudyLookAlikes(flags);
  LOWLAP_ASSIGN_OR_RETURN(auto study, PlanRobustnessStudy(flags.options));
  LOWLAP_RETURN_IF_ERROR(Complete(flags, MakeContext(flags.common), &study));
  LOWLAP_RETURN_IF_ERROR(WriteRobustness(study, flags.output));
  std::printf(
      "%s\n%zu scenarios, %zu trials, %zu strategies\n"
      "written to %s: index.html summary.txt curves.csv trials.csv and plots "
      "(.svg)\n",
      SummaryText(study).c_str(), study.scenarios.size(), study.outcomes.size(),
      study.options.strategies.size(), flags.output.c_str());
  return 0;
}

}  // namespace

void AddRobustness(CLI::App* program, Action* action) {
  auto flags = std::make_shared<RobustnessFlags>();
  RobustnessOptions& o = flags->options;
  CLI::App* command = AddCommand(
      program, "robustness",
      "Breakdown curves of every strategy on simulated rooms, corridors and "
      "rings");
  AddOption(command, "-o,--output", flags->output,
            "Folder for tables and plots. A study that was stopped goes "
            "on from the trials there")
      .Required();
  const Option scenario =
      AddOption(command, "--scenario", o.scenarios,
                "What gets worse, separated by commas; all if left out: " +
                    Joined(RobustnessScenarioNames(), ", "))
          .SeparatedBy(',');
  const Option strategies = AddStrategiesFlag(command, &o.strategies);
  const Option seeds =
      AddOption(command, "--seeds", o.num_seeds, "Simulations per value")
          .ShowDefault();
  const Option tolerance =
      AddOption(command, "--tolerance", o.tolerance,
                "A centre is right within this share of the spread")
          .ShowDefault();
  const Option time_limit =
      AddOption(command, "--time-limit", o.time_limit_s,
                "Seconds of processor time that a strategy has for one "
                "problem; beyond, it is not asked for larger ones")
          .ShowDefault();
  const Option quick =
      AddFlag(command, "--quick", o.quick,
              "The room alone, few values, small graphs: seconds");
  Option trust =
      AddFlag(command, "--trust", flags->trust,
              "Another study: scenes of all kinds, with everything wrong that "
              "can be simulated, are solved as solve does; counted are the "
              "cameras graded firm or doubtful against their true errors, and "
              "what is made of features that have nothing to do with each "
              "other");
  AddOption(command, "--scenes", flags->num_scenes,
            "Simulations of each of its families")
      .Must(Check::Positive())
      .ShowDefault()
      .Needs(trust);
  Option look_alikes =
      AddFlag(command, "--look-alikes", flags->look_alikes,
              "Another study: photographs are rendered of places that have "
              "tiles, windows or shelves in common and nothing else; counted "
              "are the pairs that a relative pose joins, and those of one "
              "place for comparison")
          .Excludes(trust);
  AddOption(command, "--pairs", flags->num_pairs,
            "Pairs of different places, and of one, for each pattern")
      .Must(Check::Positive())
      .ShowDefault()
      .Needs(look_alikes);
  for (const Option& of_curves :
       {scenario, strategies, seeds, tolerance, time_limit, quick}) {
    trust.Excludes(of_curves);
    look_alikes.Excludes(of_curves);
  }
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, StudyAndWrite, action);
}

}  // namespace lowlap::cli
