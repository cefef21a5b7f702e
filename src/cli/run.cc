#include <memory>
#include <optional>
#include <utility>

#include "cli/command.h"
#include "cli/solve_flags.h"
#include "lowlap/pipeline/calibrate_images.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/output_folder.h"
#include "third_party_adapters/strecha/strecha.h"

namespace lowlap::cli {
namespace {

struct RunFlags {
  CommonFlags common;
  std::string images;
  std::string output;
  std::string intrinsics;
  std::optional<double> focal_px;
  std::string pairs = "all";
  std::vector<std::string> exclude;
  SolveFlags solve;
};

int Run(const RunFlags& flags) {
  const RunContext context = MakeContext(flags.common);
  // Everything that can be refused is refused before the long work.
  const auto options = MakeSolveOptions(flags.solve);
  if (!options) return Fail(options.error());
  IntrinsicSource intrinsics;
  intrinsics.focal_px = flags.focal_px;
  if (!flags.intrinsics.empty()) {
    const auto matrix = strecha::ReadCalibrationMatrix(flags.intrinsics);
    if (!matrix) return Fail(matrix.error());
    intrinsics.calibration = *matrix;
  }
  auto scene = SceneFromImages(flags.images, intrinsics, flags.exclude);
  if (!scene) return Fail(scene.error());
  const auto truth = LoadGroundTruth(flags.solve.ground_truth, *scene);
  if (!truth) return Fail(truth.error());

  FrontEndOptions front_end;
  front_end.pairs = flags.pairs;
  const bool needs_lines =
      options->scale.use_lines || options->scale.use_coplanar;
  front_end.features.detect_lines = needs_lines;
  front_end.matching.match_lines = needs_lines;

  StageLog stages;
  RunSummary summary;
  summary.command = "run";
  auto pairs = MeasureImages(&*scene, front_end, context, &stages);
  if (!pairs) return Fail(pairs.error());
  summary.pairs = std::move(*pairs);
  return SolveAndWrite(std::move(*scene), flags.solve, std::move(summary),
                       &stages, context, flags.output);
}

}  // namespace

void AddRun(CLI::App* program, Action* action) {
  auto flags = std::make_shared<RunFlags>();
  CLI::App* command = program->add_subcommand(
      "run",
      "Calibrate a folder of photographs: features, matches, relative "
      "poses, scale ratios, poses, bundle adjustment");
  command->add_option("images", flags->images, "Folder of photographs")
      ->required();
  command->add_option("-o,--output", flags->output, "Folder for the results")
      ->required();
  auto* matrix = command->add_option(
      "--intrinsics", flags->intrinsics,
      "K.txt: the 3x3 calibration matrix of all photographs, in pixels "
      "(fx and fy are both used)");
  auto* focal =
      command
          ->add_option("--focal", flags->focal_px,
                       "Focal length in pixels; principal point in the middle")
          ->check(CLI::PositiveNumber);
  matrix->excludes(focal);
  command->add_option("--pairs", flags->pairs,
                      "Pairs to match: all, chain, cycle, window:N, or a file "
                      "with two view names or ids a line");
  command
      ->add_option("--exclude", flags->exclude,
                   "Photographs to leave out, separated by commas")
      ->delimiter(',');
  AddSolveFlags(command, &flags->solve);
  AddCommonFlags(command, &flags->common);
  command->callback(
      [flags, action] { *action = [flags] { return Run(*flags); }; });
}

}  // namespace lowlap::cli
