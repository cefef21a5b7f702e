#include <algorithm>
#include <memory>
#include <utility>

#include "cli/command.h"
#include "cli/flags/intrinsics_input.h"
#include "cli/flags/solve_flags.h"
#include "cli/flags/truth.h"
#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/internal/measure/measure_and_refine.h"
#include "lowlap/pipeline/internal/output/run_output.h"

namespace lowlap::cli {
namespace {

struct RunFlags {
  CommonFlags common;
  std::string images;
  std::string output;
  IntrinsicsFlags intrinsics;
  std::string pairs = "all";
  std::string matcher = "exact";
  std::vector<std::string> two_view = {"points", "lines"};
  std::vector<std::string> exclude;
  std::string cache;
  bool no_cache = false;
  bool refine_points = false;
  SolveFlags solve;
};

bool IsNamed(const char* name, const std::vector<std::string>& names) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

Result<int> Run(const RunFlags& flags) {
  const RunContext context = MakeContext(flags.common);
  // Everything that can be refused is refused before the long work.
  LOWLAP_ASSIGN_OR_RETURN(const auto options, MakeSolveOptions(flags.solve));
  LOWLAP_ASSIGN_OR_RETURN(const auto scale,
                          MakeScaleOptions(flags.solve.scale));
  LOWLAP_ASSIGN_OR_RETURN(const auto refinement,
                          ParseRefinement(flags.solve.refine_intrinsics));
  LOWLAP_RETURN_IF_ERROR(CheckOutputFolder(flags.output));
  LOWLAP_ASSIGN_OR_RETURN(const auto intrinsics,
                          ReadIntrinsics(flags.intrinsics));
  std::vector<std::string> notes;
  LOWLAP_ASSIGN_OR_RETURN(auto scene, SceneFromImages(flags.images, intrinsics,
                                                      flags.exclude, &notes));
  for (const std::string& note : notes) context.Log(LogLevel::kWarning, note);
  LOWLAP_RETURN_IF_ERROR(LoadGroundTruth(flags.solve.ground_truth, scene));

  if (!flags.intrinsics.AreGiven() && flags.solve.refine_intrinsics.empty()) {
    context.Log(LogLevel::kInfo,
                "focal lengths are those of the EXIF data, a few percent off "
                "as a rule; --refine-intrinsics adjusts them");
  }

  MeasurementOptions front_end;
  if (!flags.no_cache) {
    front_end.cache_folder =
        flags.cache.empty() ? flags.output + "/cache" : flags.cache;
  }
  front_end.pairs = flags.pairs;
  const PointMatcher matcher =
      flags.matcher == "flann" ? PointMatcher::kFlann : PointMatcher::kExact;
  front_end.matching.points.matcher = matcher;
  front_end.matching.relaxed_points.matcher = matcher;
  front_end.refine_points = flags.refine_points;
  front_end.relative_poses.pair.use_points = IsNamed("points", flags.two_view);
  front_end.relative_poses.pair.use_lines = IsNamed("lines", flags.two_view);
  const bool needs_lines = front_end.relative_poses.pair.use_lines ||
                           scale.Asks("lines") || scale.Asks("coplanar");
  front_end.features.detect_lines = needs_lines;
  front_end.matching.match_lines = needs_lines;

  StageLog stages;
  RunSummary summary;
  summary.command = "run";
  auto report = MeasureAndRefine(&scene, front_end, options, refinement,
                                 context, &stages);
  if (!report) {
    if (IsInterrupted() && !flags.no_cache) {
      context.Log(LogLevel::kInfo, "what was measured is kept in " +
                                       front_end.cache_folder +
                                       "; the same command goes on from there");
    }
    if (report.error().file.empty()) report.error().file = flags.images;
    return tl::unexpected<Error>(report.error());
  }
  summary.pairs = std::move(report->pairs);
  summary.unrelated = std::move(report->unrelated);
  return SolveAndWrite(std::move(scene), flags.solve, std::move(summary),
                       &stages, context, flags.images, flags.output);
}

}  // namespace

void AddRun(CLI::App* program, Action* action) {
  auto flags = std::make_shared<RunFlags>();
  CLI::App* command = AddCommand(
      program, "run",
      "Calibrate a folder of photographs: features, matches, relative "
      "poses, scale ratios, poses, bundle adjustment");
  AddOption(command, "images", flags->images, "Folder of photographs")
      .Required();
  AddOption(command, "-o,--output", flags->output, "Folder for the results")
      .Required();
  AddIntrinsicsFlags(command, &flags->intrinsics);
  AddOption(command, "--pairs", flags->pairs,
            "Pairs to match: all, chain, cycle, window:N, auto (those "
            "that look alike), or a file with two view names or ids a "
            "line")
      .ShowDefault();
  AddOption(command, "--matcher", flags->matcher,
            "How points are matched: exact, or flann (approximately, "
            "faster where photographs have hundreds of thousands of points)")
      .Must(Check::OneOf({"exact", "flann"}))
      .ShowDefault();
  AddOption(command, "--exclude", flags->exclude,
            "Photographs to leave out, separated by commas")
      .SeparatedBy(',');
  AddOption(command, "--two-view", flags->two_view,
            "What relative poses are estimated from, separated by "
            "commas: points, lines")
      .SeparatedBy(',')
      .Must(Check::OneOf({"points", "lines"}))
      .ShowDefault();
  Option cache = AddOption(
      command, "--cache", flags->cache,
      "Folder of features and matches to use again; default OUTPUT/cache");
  AddFlag(command, "--no-cache", flags->no_cache,
          "Neither use nor keep features and matches")
      .Excludes(cache);
  AddFlag(command, "--refine-points", flags->refine_points,
          "Align matched points by their grey values, to a fraction "
          "of a pixel");
  AddSolveFlags(command, &flags->solve);
  AddStrictFlag(command, &flags->solve.strict);
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, Run, action);
}

}  // namespace lowlap::cli
