#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "cli/command.h"
#include "cli/flags/scene_input.h"
#include "cli/flags/solve_flags.h"
#include "cli/flags/truth.h"
#include "lowlap/core/internal/hash.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/io/internal/scene_binary.h"
#include "lowlap/pipeline/internal/output/output_folder.h"
#include "lowlap/pipeline/internal/scene_reduction.h"
#include "lowlap/report/internal/table_text.h"
#include "lowlap/study/internal/result_log.h"
#include "lowlap/study/internal/subset_runs.h"
#include "lowlap/study/internal/subset_table.h"

namespace lowlap::cli {
namespace {

struct SubsetsFlags {
  CommonFlags common;
  SceneInputFlags input;
  SolveFlags solve;
  std::string output;
  int drop = 3;
  std::size_t sample = 0;
  int jobs = 0;
  int max_point_matches = 150;
  SubsetBounds bounds;
};

// What the results depend on, apart from the choice of the subsets.
Result<std::string> SettingsText(const SubsetsFlags& flags, const Scene& scene,
                                 const GroundTruth& truth) {
  LOWLAP_ASSIGN_OR_RETURN(const auto bytes, FormatSceneBinary(scene));
  Hash128 hash;
  hash.Add(bytes);
  for (const auto& [view, pose] : truth) {
    hash.Add(view.value());
    for (const double value : pose.center) hash.Add(value);
    for (const double value : pose.rotation.reshaped()) hash.Add(value);
  }
  std::string text =
      "version " LOWLAP_VERSION "\nscene " + ToHex(hash.value()) + "\nseed " +
      std::to_string(flags.common.seed) + "\nstrategy " + flags.solve.strategy +
      "\nscale " + flags.solve.scale.criterion + " " + flags.solve.scale.nfa +
      " " +
      std::to_string(
          flags.solve.scale.threshold_px.value_or(ScaleOptions{}.threshold_px));
  for (const std::string& kind : flags.solve.scale.features) {
    text += " " + kind;
  }
  for (const auto& [kind, asked] : flags.solve.scale.asked) {
    if (asked) text += " " + kind;
  }
  text += flags.solve.no_adjust ? "\nno adjustment" : "\nadjustment";
  for (const std::string& kind : flags.solve.adjust_features) {
    text += " " + kind;
  }
  return text + "\nties " +
         flags.solve.coplanar_ties.value_or(kDefaultCoplanarTies) +
         (flags.solve.directions.value_or(AdjustmentOptions{}.use_directions)
              ? "\ndirections"
              : "\nno directions") +
         "\nrefine " + flags.solve.refine_intrinsics + "\nprincipal point " +
         NumberText(flags.solve.principal_point_stddev, 9) + "\n";
}

// What no warning tells of.
void PrintUnsaid(const std::vector<SubsetOutcome>& outcomes, const Scene& scene,
                 const SubsetBounds& bounds) {
  for (const SubsetOutcome& outcome : outcomes) {
    std::string dropped;
    for (const ViewId view : outcome.dropped) {
      dropped += " " + scene.NameOf(view);
    }
    if (IsSilentFailure(outcome, bounds)) {
      std::printf("silent failure without%s: %s is off by %.3f\n",
                  dropped.c_str(), scene.NameOf(outcome.worst_view).c_str(),
                  outcome.max_error);
    }
    for (const ViewId view : WrongFirmViews(outcome, bounds)) {
      std::printf("named in no warning, without%s: %s is off by %.3f\n",
                  dropped.c_str(), scene.NameOf(view).c_str(),
                  outcome.firm_errors.at(view));
    }
  }
}

Result<int> Finish(const std::vector<SubsetOutcome>& outcomes,
                   const Scene& scene, const SubsetsFlags& flags) {
  const SubsetSummary summary = SummarizeSubsets(outcomes, flags.bounds);
  LOWLAP_ASSIGN_OR_RETURN(const auto plot, DrawSubsets(outcomes));
  LOWLAP_RETURN_IF_ERROR(
      WriteTextFiles({{"results.csv", ToCsv(outcomes, scene)},
                      {"summary.json", ToJson(summary, flags.bounds)},
                      {"results.svg", plot}},
                     flags.output));
  PrintUnsaid(outcomes, scene, flags.bounds);
  std::printf("%s", ToText(summary, flags.bounds).c_str());
  std::printf("written to %s: results.csv summary.json results.svg\n",
              flags.output.c_str());
  return 0;
}

// How long `left` more take if each takes as long as those before.
std::string TimeLeft(double seconds, std::size_t done, std::size_t left) {
  if (done == 0) return "";
  const double minutes =
      seconds / 60 * static_cast<double>(left) / static_cast<double>(done);
  char text[48];
  if (minutes < 1.5) return " (a minute left)";
  std::snprintf(text, sizeof text,
                minutes < 90 ? " (%.0f minutes left)" : " (%.1f hours left)",
                minutes < 90 ? minutes : minutes / 60);
  return text;
}

// Adds the time left to the progress of the subsets; where no one watches it, a
// note after each tenth.
void EstimateTimeLeft(RunContext* context) {
  using Clock = std::chrono::steady_clock;
  struct State {
    std::optional<Clock::time_point> start;
    std::size_t noted = 0;
  };
  const auto state = std::make_shared<State>();
  context->progress =
      [state, plain = *context, watched = ::isatty(STDERR_FILENO) != 0](
          const std::string& stage, std::size_t done, std::size_t total) {
        if (stage != "subsets") return plain.Progress(stage, done, total);
        if (!state->start) state->start = Clock::now();
        const double seconds =
            std::chrono::duration<double>(Clock::now() - *state->start).count();
        const std::string left = TimeLeft(seconds, done, total - done);
        if (!watched && done < total && 10 * done / total > state->noted) {
          state->noted = 10 * done / total;
          plain.Log(LogLevel::kInfo, "subsets: " + std::to_string(done) +
                                         " of " + std::to_string(total) + left);
        }
        return plain.Progress(stage + left, done, total);
      };
}

Result<int> Subsets(const SubsetsFlags& flags) {
  RunContext context = MakeContext(flags.common);
  EstimateTimeLeft(&context);
  if (flags.jobs > 0) context.num_threads = flags.jobs;
  LOWLAP_ASSIGN_OR_RETURN(auto options, MakeSolveOptions(flags.solve));
  LOWLAP_RETURN_IF_ERROR(flags.bounds.Validate());
  // A folder that cannot be written is found before the work.
  LOWLAP_RETURN_IF_ERROR(CheckOutputFolder(flags.output));
  StageLog stages;
  LOWLAP_ASSIGN_OR_RETURN(auto loaded,
                          LoadMeasuredScene(flags.input, context, &stages));
  Scene scene = std::move(loaded.scene);
  DropSolution(&scene);
  if (flags.max_point_matches > 0) {
    LOWLAP_RETURN_IF_ERROR(LimitPointMatches(flags.max_point_matches, &scene));
  }
  LOWLAP_ASSIGN_OR_RETURN(const auto truth,
                          LoadGroundTruth(flags.solve.ground_truth, scene));
  LOWLAP_RETURN_IF_ERROR(SetRefinement(flags.solve.refine_intrinsics, &scene,
                                       &options.adjustment));
  WarnOfIdleTies(flags.solve.coplanar_ties, flags.solve.directions,
                 options.adjustment, context);
  LOWLAP_ASSIGN_OR_RETURN(
      const auto chosen,
      ChooseSubsets(scene, flags.drop, flags.sample, flags.common.seed));
  LOWLAP_ASSIGN_OR_RETURN(const auto settings,
                          SettingsText(flags, scene, *truth));
  OutputFolder folder;
  LOWLAP_RETURN_IF_ERROR(folder.Make(flags.output));
  std::map<std::vector<ViewId>, SubsetOutcome> outcomes;
  const auto log = ResultLog::Open(
      (std::filesystem::path(flags.output) / "results.jsonl").string(),
      settings, [&](const std::string& record) {
        auto outcome = SubsetFromJsonLine(record);
        if (outcome) outcomes[outcome->dropped] = std::move(*outcome);
        return outcome.has_value();
      });
  if (!log) return tl::unexpected<Error>(log.error());
  std::vector<std::vector<ViewId>> missing;
  for (const std::vector<ViewId>& dropped : chosen) {
    if (outcomes.count(dropped) == 0) missing.push_back(dropped);
  }
  if (missing.size() < chosen.size()) {
    context.Log(LogLevel::kInfo,
                std::to_string(chosen.size() - missing.size()) +
                    " subsets are in results.jsonl already");
  }
  const Status done = RunSubsets(scene, *truth, missing, options, context,
                                 [&](const SubsetOutcome& outcome) {
                                   outcomes[outcome.dropped] = outcome;
                                   return log->Append(ToJsonLine(outcome));
                                 });
  if (!done) return tl::unexpected<Error>(done.error());
  // In the order of the subsets, whatever order they were finished in, and
  // without those that an earlier run was asked for.
  std::vector<SubsetOutcome> asked_for;
  for (const std::vector<ViewId>& dropped : chosen) {
    asked_for.push_back(outcomes.at(dropped));
  }
  return Finish(asked_for, scene, flags);
}

}  // namespace

void AddSubsets(CLI::App* program, Action* action) {
  auto flags = std::make_shared<SubsetsFlags>();
  // Coplanar pairs take most of the adjustment's time, and matter little where
  // points are many.
  flags->solve.adjust_features = {"points", "lines"};
  CLI::App* command = AddCommand(
      program, "subsets",
      "Solve a measured scene once for every way to drop some of its views, "
      "and compare with the truth: how many are solved, how well, and whether "
      "failures are flagged");
  AddSceneInputFlags(command, &flags->input);
  AddOption(command, "-o,--output,--outdir", flags->output,
            "Folder for results.csv, summary.json and results.svg. A "
            "run that was stopped goes on from the results there")
      .Required();
  AddOption(command, "--drop", flags->drop, "Number of views to leave out")
      .ShowDefault();
  AddOption(command, "--sample,--limit", flags->sample,
            "Only so many of the ways, drawn with --seed; 0: all")
      .Must(Check::WholeNumber())
      .ShowDefault();
  AddOption(command, "--jobs", flags->jobs,
            "Subsets to solve at a time, each on one thread; default "
            "--threads")
      .Must(Check::Between(0, 1024));
  AddOption(command, "--max-point-matches", flags->max_point_matches,
            "Point matches to use of each pair, those on the longest "
            "tracks first; 0: all")
      .Must(Check::NonNegative())
      .ShowDefault();
  AddOption(command, "--good", flags->bounds.accurate,
            "Largest position error of a good solution, in the unit of "
            "the true cameras")
      .ShowDefault();
  AddOption(command, "--wrong", flags->bounds.failed,
            "A camera is wrong beyond this")
      .ShowDefault();
  AddSolveFlags(command, &flags->solve);
  FindOption(command, "--gt").Required();
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, Subsets, action);
}

}  // namespace lowlap::cli
