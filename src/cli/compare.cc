#include <cstdio>
#include <memory>
#include <utility>

#include "cli/command.h"
#include "cli/flags/scene_input.h"
#include "cli/flags/solve_flags.h"
#include "cli/flags/truth.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/run_output.h"
#include "lowlap/study/compare_strategies.h"

namespace lowlap::cli {
namespace {

struct CompareFlags {
  CommonFlags common;
  SceneInputFlags input;
  SolveFlags solve;
  std::vector<std::string> strategies = {"all"};
  std::string reference = "graph";
  std::string output;
};

Result<int> Compare(const CompareFlags& flags) {
  const RunContext context = MakeContext(flags.common);
  CompareOptions options;
  options.strategies = flags.strategies;
  options.reference = flags.reference;
  LOWLAP_ASSIGN_OR_RETURN(options.solve, MakeSolveOptions(flags.solve));
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  WarnOfIdleTies(flags.solve.coplanar_ties, flags.solve.directions,
                 options.solve.adjustment, context);
  // A folder that cannot be written is found before the work.
  LOWLAP_RETURN_IF_ERROR(CheckOutputFolder(flags.output));
  StageLog stages;
  LOWLAP_ASSIGN_OR_RETURN(const auto loaded,
                          LoadMeasuredScene(flags.input, context, &stages));
  LOWLAP_ASSIGN_OR_RETURN(
      options.truth, LoadGroundTruth(flags.solve.ground_truth, loaded.scene));

  LOWLAP_ASSIGN_OR_RETURN(const auto comparison,
                          CompareStrategies(loaded.scene, options, context));
  if (IsInterrupted()) return MakeError(ErrorCode::kCancelled, {});
  LOWLAP_RETURN_IF_ERROR(
      WriteComparison(comparison, loaded.scene, flags.output));
  std::printf("%s\nwritten to %s: compare.csv compare.json and plots (.svg)\n",
              ToText(comparison).c_str(), flags.output.c_str());
  return 0;
}

}  // namespace

void AddCompare(CLI::App* program, Action* action) {
  auto flags = std::make_shared<CompareFlags>();
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
  RunWhenChosen(command, flags, Compare, action);
}

}  // namespace lowlap::cli
