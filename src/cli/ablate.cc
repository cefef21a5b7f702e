#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/flags/scene_input.h"
#include "cli/flags/solve_flags.h"
#include "cli/flags/truth.h"
#include "lowlap/averaging/averager_registry.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/run_output.h"
#include "lowlap/study/internal/ablation.h"

namespace lowlap::cli {
namespace {

struct AblateFlags {
  CommonFlags common;
  SceneInputFlags input;
  std::string strategy = "graph";
  std::vector<double> thresholds_px = AblationOptions().thresholds_px;
  std::string ground_truth;
  std::string output;
};

Result<int> RunAblation(const AblateFlags& flags) {
  const RunContext context = MakeContext(flags.common);
  AblationOptions options;
  options.thresholds_px = flags.thresholds_px;
  LOWLAP_ASSIGN_OR_RETURN(
      options.solve.poses.averager,
      AveragerRegistry::WithBuiltIns().Make(flags.strategy));
  LOWLAP_RETURN_IF_ERROR(options.Validate());
  if (!flags.output.empty()) {
    // A folder that cannot be written is found before the work.
    LOWLAP_RETURN_IF_ERROR(CheckOutputFolder(flags.output));
  }
  StageLog stages;
  LOWLAP_ASSIGN_OR_RETURN(const auto loaded,
                          LoadMeasuredScene(flags.input, context, &stages));
  LOWLAP_ASSIGN_OR_RETURN(const auto truth,
                          LoadGroundTruth(flags.ground_truth, loaded.scene));
  if (!truth) {
    return MakeError(ErrorCode::kInvalidArgument, "--gt names no cameras");
  }
  LOWLAP_ASSIGN_OR_RETURN(const auto ablation,
                          Ablate(loaded.scene, *truth, options, context));
  if (IsInterrupted()) return MakeError(ErrorCode::kCancelled, {});
  if (!flags.output.empty()) {
    LOWLAP_RETURN_IF_ERROR(WriteAblation(ablation, flags.output));
  }
  std::printf("%s", ToText(ablation).c_str());
  if (!flags.output.empty()) {
    std::printf("\nwritten to %s: ablate.csv ablate.json and plots (.svg)\n",
                flags.output.c_str());
  }
  return 0;
}

}  // namespace

void AddAblate(CLI::App* program, Action* action) {
  auto flags = std::make_shared<AblateFlags>();
  CLI::App* command = AddCommand(
      program, "ablate",
      "Position errors with fixed inlier thresholds and without, by kind of "
      "feature (the paper's experiments), and by what holds the bundle "
      "adjustment, on any scene with true cameras");
  AddSceneInputFlags(command, &flags->input);
  AddTruthFlag(command, &flags->ground_truth).Required();
  AddOption(command, "-o,--output,--outdir", flags->output,
            "Folder for the tables and plots; none if not given");
  AddStrategyFlag(command, &flags->strategy);
  AddOption(command, "--thresholds", flags->thresholds_px,
            "Fixed inlier thresholds in pixels, separated by commas")
      .SeparatedBy(',')
      .ShowDefault();
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, RunAblation, action);
}

}  // namespace lowlap::cli
