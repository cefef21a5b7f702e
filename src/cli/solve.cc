#include <memory>
#include <utility>

#include "cli/command.h"
#include "cli/scene_input.h"
#include "cli/solve_flags.h"
#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/output_folder.h"

namespace lowlap::cli {
namespace {

struct Flags {
  CommonFlags common;
  SceneInputFlags input;
  std::string output;
  SolveFlags solve;
};

Result<int> Solve(const Flags& flags) {
  const RunContext context = MakeContext(flags.common);
  LOWLAP_RETURN_IF_ERROR(MakeSolveOptions(flags.solve));
  // A folder that cannot be written is found before the work.
  LOWLAP_RETURN_IF_ERROR(CheckOutputFolder(flags.output));
  StageLog stages;
  RunSummary summary;
  summary.command = "solve";
  LOWLAP_ASSIGN_OR_RETURN(auto loaded,
                          LoadMeasuredScene(flags.input, context, &stages));
  summary.pairs = std::move(loaded.pairs);
  RestoreGivenIntrinsics(&loaded.scene);
  return SolveAndWrite(std::move(loaded.scene), flags.solve, std::move(summary),
                       &stages, context, flags.input.scene, flags.output);
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
  RunWhenChosen(command, flags, Solve, action);
}

}  // namespace lowlap::cli
