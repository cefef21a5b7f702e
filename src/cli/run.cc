#include <memory>
#include <utility>

#include "cli/command.h"
#include "cli/flags/photographs.h"
#include "cli/flags/solve_flags.h"
#include "cli/flags/truth.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/run_output.h"

namespace lowlap::cli {
namespace {

struct RunFlags {
  CommonFlags common;
  PhotographFlags photographs;
  bool no_cache = false;
  std::string output;
  SolveFlags solve;
};

Result<int> Run(const RunFlags& flags) {
  const RunContext context = MakeContext(flags.common);
  // Everything that can be refused is refused before the long work.
  LOWLAP_RETURN_IF_ERROR(MakeSolveOptions(flags.solve));
  LOWLAP_RETURN_IF_ERROR(CheckOutputFolder(flags.output));
  PhotographFlags photographs = flags.photographs;
  if (photographs.cache.empty() && !flags.no_cache) {
    photographs.cache = flags.output + "/cache";
  }
  LOWLAP_ASSIGN_OR_RETURN(auto scene, OpenPhotographs(photographs, context));
  LOWLAP_RETURN_IF_ERROR(LoadGroundTruth(flags.solve.ground_truth, scene));

  StageLog stages;
  RunSummary summary;
  summary.command = "run";
  LOWLAP_ASSIGN_OR_RETURN(
      auto report,
      MeasurePhotographs(photographs, flags.solve, context, &stages, &scene));
  summary.pairs = std::move(report.pairs);
  summary.unrelated = std::move(report.unrelated);
  summary.detected = std::move(report.detected);
  return SolveAndWrite(std::move(scene), flags.solve, std::move(summary),
                       &stages, context, photographs.images, {flags.output});
}

}  // namespace

void AddRun(CLI::App* program, Action* action) {
  auto flags = std::make_shared<RunFlags>();
  CLI::App* command = AddCommand(
      program, "run",
      "Calibrate a folder of photographs: features, matches, relative "
      "poses, scale ratios, poses, bundle adjustment");
  PhotographFlags& photographs = flags->photographs;
  AddOption(command, "images", photographs.images,
            "Folder of photographs; not those in its subfolders")
      .Required();
  AddOption(command, "-o,--output", flags->output, "Folder for the results")
      .Required();
  AddIntrinsicsFlags(command, &photographs.intrinsics);
  AddPairsFlag(command, &photographs.pairs, "Pairs to match");
  AddOption(command, "--matcher", photographs.choices.matcher,
            "How points are matched: exact, or flann (approximately, "
            "faster where photographs have hundreds of thousands of points)")
      .Must(Check::OneOf({"exact", "flann"}))
      .ShowDefault();
  AddMaxTiltFlag(command, &photographs.choices.max_tilt);
  AddOption(command, "--exclude", photographs.exclude,
            "Photographs to leave out, separated by commas")
      .SeparatedBy(',');
  AddOption(command, "--two-view", photographs.choices.two_view,
            "What relative poses are estimated from, separated by "
            "commas: points, lines")
      .SeparatedBy(',')
      .Must(Check::OneOf({"points", "lines"}))
      .ShowDefault();
  Option cache = AddOption(
      command, "--cache", photographs.cache,
      "Folder of features and matches to use again; default OUTPUT/cache");
  AddFlag(command, "--no-cache", flags->no_cache,
          "Neither use nor keep features and matches")
      .Excludes(cache);
  AddFlag(command, "--refine-points", photographs.refine_points,
          "Align matched points by their grey values, to a fraction "
          "of a pixel");
  AddSolveFlags(command, &flags->solve);
  AddStrictFlag(command, &flags->solve.strict);
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, Run, action);
}

}  // namespace lowlap::cli
