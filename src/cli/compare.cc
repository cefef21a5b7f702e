#include <cstdio>
#include <memory>
#include <utility>

#include "cli/command.h"
#include "cli/scene_input.h"
#include "cli/solve_flags.h"
#include "cli/truth.h"
#include "lowlap/pipeline/internal/output/output_folder.h"
#include "lowlap/study/compare_strategies.h"

namespace lowlap::cli {
namespace {

struct Flags {
  CommonFlags common;
  SceneInputFlags input;
  SolveFlags solve;
  std::vector<std::string> strategies = {"all"};
  std::string reference = "graph";
  std::string output;
};

int Compare(const Flags& flags) {
  const RunContext context = MakeContext(flags.common);
  CompareOptions options;
  options.strategies = flags.strategies;
  options.reference = flags.reference;
  const auto solve = MakeSolveOptions(flags.solve);
  if (!solve) return Fail(solve.error());
  options.solve = *solve;
  if (const Status valid = options.Validate(); !valid) {
    return Fail(valid.error());
  }
  // A folder that cannot be written is found before the work.
  if (const Status usable = CheckOutputFolder(flags.output); !usable) {
    return Fail(usable.error());
  }
  StageLog stages;
  const auto loaded = LoadMeasuredScene(flags.input, context, &stages);
  if (!loaded) return Fail(loaded.error());
  auto truth = LoadGroundTruth(flags.solve.ground_truth, loaded->scene);
  if (!truth) return Fail(truth.error());
  options.truth = std::move(*truth);

  const auto comparison = CompareStrategies(loaded->scene, options, context);
  if (!comparison) return Fail(comparison.error());
  if (IsInterrupted()) return Fail({ErrorCode::kCancelled, {}, {}, {}});
  if (const Status written =
          WriteComparison(*comparison, loaded->scene, flags.output);
      !written) {
    return Fail(written.error());
  }
  std::printf("%s\nwritten to %s: compare.csv compare.json and plots (.svg)\n",
              ToText(*comparison).c_str(), flags.output.c_str());
  return 0;
}

}  // namespace

void AddCompare(CLI::App* program, Action* action) {
  auto flags = std::make_shared<Flags>();
  CLI::App* command = AddCommand(
      program, "compare",
      "Run every strategy of composing poses on the same relative poses and "
      "scale ratios");
  AddSceneInputFlags(command, &flags->input);
  AddOption(command, "-o,--output,--outdir", flags->output,
            "Folder for the tables and plots")
      .Required();
  AddStrategiesFlag(command, &flags->strategies).ShowDefault("all");
  AddOption(command, "--reference", flags->reference,
            "The strategy whose cameras the others are compared with "
            "where there are no true ones; if it places none, the "
            "first that does")
      .ShowDefault();
  AddScaleFlags(command, &flags->solve.scale);
  AddAdjustFlags(command, &flags->solve);
  AddTruthFlag(command, &flags->solve.ground_truth);
  AddCommonFlags(command, &flags->common);
  WhenChosen(command, [flags, action] {
    *action = [flags] { return Compare(*flags); };
  });
}

}  // namespace lowlap::cli
