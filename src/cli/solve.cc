#include <memory>
#include <utility>

#include "cli/command.h"
#include "cli/scene_input.h"
#include "cli/solve_flags.h"
#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/pipeline/internal/output/output_folder.h"

namespace lowlap::cli {
namespace {

struct Flags {
  CommonFlags common;
  SceneInputFlags input;
  std::string output;
  SolveFlags solve;
};

int Solve(const Flags& flags) {
  const RunContext context = MakeContext(flags.common);
  if (const auto options = MakeSolveOptions(flags.solve); !options) {
    return Fail(options.error());
  }
  // A folder that cannot be written is found before the work.
  if (const Status usable = CheckOutputFolder(flags.output); !usable) {
    return Fail(usable.error());
  }
  StageLog stages;
  RunSummary summary;
  summary.command = "solve";
  auto loaded = LoadMeasuredScene(flags.input, context, &stages);
  if (!loaded) return Fail(loaded.error());
  summary.pairs = std::move(loaded->pairs);
  RestoreGivenIntrinsics(&loaded->scene);
  return SolveAndWrite(std::move(loaded->scene), flags.solve,
                       std::move(summary), &stages, context, flags.input.scene,
                       flags.output);
}

}  // namespace

void AddSolve(CLI::App* program, Action* action) {
  auto flags = std::make_shared<Flags>();
  CLI::App* command = AddCommand(
      program, "solve",
      "Solve a scene description (ours, or an OpenMVG project): scale "
      "ratios, poses, bundle adjustment");
  AddSceneInputFlags(command, &flags->input);
  AddOption(command, "-o,--output,--outdir", flags->output,
            "Folder for the results")
      .Required();
  AddSolveFlags(command, &flags->solve);
  AddStrictFlag(command, &flags->solve.strict);
  AddCommonFlags(command, &flags->common);
  WhenChosen(command,
             [flags, action] { *action = [flags] { return Solve(*flags); }; });
}

}  // namespace lowlap::cli
