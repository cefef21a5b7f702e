#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/flags/intrinsics_input.h"
#include "cli/flags/scene_input.h"
#include "cli/flags/solve_flags.h"
#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/merge/merge_models.h"
#include "lowlap/pipeline/internal/output/output_folder.h"
#include "lowlap/pipeline/measure_images.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

struct Flags {
  CommonFlags common;
  std::vector<std::string> models;
  SceneInputFlags measured;
  IntrinsicsFlags intrinsics;
  std::string pairs = "all";
  std::string cache;
  std::string output;
  SolveFlags solve;
};

// The measured scene, from photographs or as it was measured before.
Result<LoadedScene> Measure(const Flags& flags, const RunContext& context,
                            StageLog* stages) {
  if (!flags.measured.scene.empty()) {
    LOWLAP_ASSIGN_OR_RETURN(auto loaded,
                            LoadMeasuredScene(flags.measured, context, stages));
    RestoreGivenIntrinsics(&loaded.scene);
    return loaded;
  }
  const std::string& images = flags.measured.images;
  if (images.empty()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "--images (photographs) or --scene (one that was "
                     "measured) is missing: the models alone do not say how "
                     "they lie to one another");
  }
  LOWLAP_ASSIGN_OR_RETURN(const auto intrinsics,
                          ReadIntrinsics(flags.intrinsics));
  std::vector<std::string> notes;
  LoadedScene loaded;
  LOWLAP_ASSIGN_OR_RETURN(
      loaded.scene,
      SceneFromImages(images, intrinsics, flags.measured.exclude, &notes));
  for (const std::string& note : notes) context.Log(LogLevel::kWarning, note);
  MeasurementOptions options;
  options.pairs = flags.pairs;
  options.cache_folder = flags.cache;
  LOWLAP_ASSIGN_OR_RETURN(
      loaded.pairs, MeasureImages(&loaded.scene, options, context, stages));
  if (loaded.scene.relative_poses.empty()) {
    return MakeError(ErrorCode::kInsufficientData, ExplainNoPose(loaded.pairs),
                     images);
  }
  return loaded;
}

Result<std::vector<Scene>> ReadModels(const Flags& flags,
                                      const RunContext& context) {
  std::vector<Scene> models;
  for (const std::string& path : flags.models) {
    SceneNotes notes;
    LOWLAP_ASSIGN_OR_RETURN(auto model, ReadScene(path, &notes));
    for (const std::string& note : notes) context.Log(LogLevel::kWarning, note);
    models.push_back(std::move(model));
  }
  return models;
}

Result<std::vector<PartialModel>> MatchModels(const Flags& flags,
                                              const std::vector<Scene>& models,
                                              const Scene& measured,
                                              const RunContext& context) {
  std::vector<PartialModel> matched;
  for (std::size_t m = 0; m < models.size(); ++m) {
    LOWLAP_ASSIGN_OR_RETURN(auto model,
                            MatchModel(measured, models[m], flags.models[m]));
    const std::size_t num_placed = GroundTruthFromScene(models[m]).size();
    if (model.poses.size() < num_placed) {
      context.Log(LogLevel::kWarning,
                  flags.models[m] + ": " +
                      std::to_string(num_placed - model.poses.size()) +
                      " of its cameras are no images of the measured scene");
    }
    matched.push_back(std::move(model));
  }
  return matched;
}

Result<int> Merge(const Flags& flags) {
  const RunContext context = MakeContext(flags.common);
  // Everything that can be refused is refused before the long work.
  LOWLAP_ASSIGN_OR_RETURN(const auto options, MakeSolveOptions(flags.solve));
  LOWLAP_RETURN_IF_ERROR(CheckOutputFolder(flags.output));
  LOWLAP_ASSIGN_OR_RETURN(const auto scenes, ReadModels(flags, context));
  StageLog stages;
  RunSummary summary;
  summary.command = "merge";
  LOWLAP_ASSIGN_OR_RETURN(auto loaded, Measure(flags, context, &stages));
  summary.pairs = std::move(loaded.pairs);
  LOWLAP_ASSIGN_OR_RETURN(const auto models,
                          MatchModels(flags, scenes, loaded.scene, context));
  std::vector<ModelCheck> checks;
  for (const PartialModel& model : models) {
    const StageLog::Scope scope(&stages, "model check");
    LOWLAP_ASSIGN_OR_RETURN(auto check,
                            CheckModel(loaded.scene, model, options, context));
    for (std::string& line : DescribeCheck(model, check, loaded.scene)) {
      std::printf("%s\n", line.c_str());
      summary.notes.push_back(std::move(line));
    }
    checks.push_back(std::move(check));
  }
  std::fflush(stdout);  // before what goes to the log
  return SolveAndWrite(std::move(loaded.scene), flags.solve, std::move(summary),
                       &stages, context, {}, flags.output,
                       [&](Scene* scene, const SolveOptions& solve,
                           const RunContext& run, StageLog* log) {
                         return MergeModels(scene, models, checks, solve, run,
                                            log);
                       });
}

}  // namespace

void AddMerge(CLI::App* program, Action* action) {
  auto flags = std::make_shared<Flags>();
  CLI::App* command = AddCommand(
      program, "merge",
      "Make one model of partial reconstructions, of any program whose format "
      "'lowlap convert' reads, and of the views that none of them placed. Each "
      "is checked against what is measured in the photographs, and cut where "
      "that contradicts it; the pieces keep their shape until all is adjusted. "
      "Without measurements that tie them, nothing is written");
  AddOption(command, "models", flags->models,
            "Scene files or folders with cameras, matched by image name")
      .Required();
  AddOption(command, "--images", flags->measured.images,
            "Folder of the photographs, which are measured as by 'lowlap run'; "
            "with a COLMAP database as --scene, its photographs");
  Option scene =
      AddOption(command, "--scene", flags->measured.scene,
                "A scene that was measured: of 'lowlap run', an OpenMVG "
                "listing with -m, or a COLMAP database");
  Option matches =
      AddOption(command, "-m,--matchdir", flags->measured.matches_dir,
                "OpenMVG matches folder of --scene (.feat and matches.* files)")
          .Needs(scene);
  AddOption(command, "-M,--match_file", flags->measured.match_file,
            "Match file in that folder; default as in OpenMVG")
      .Needs(matches);
  AddIntrinsicsFlags(command, &flags->intrinsics);
  AddOption(command, "--pairs", flags->pairs,
            "Pairs of --images to match: all, chain, cycle, window:N, auto "
            "(those that look alike), or a file with two view names or ids a "
            "line")
      .ShowDefault();
  AddOption(command, "--cache", flags->cache,
            "Folder of features and matches of --images to use again; without "
            "it none is kept");
  AddOption(command, "--exclude", flags->measured.exclude,
            "Views to leave out, separated by commas")
      .SeparatedBy(',');
  AddOption(command, "-o,--output", flags->output, "Folder for the results")
      .Required();
  AddSolveFlags(command, &flags->solve);
  AddStrictFlag(command, &flags->solve.strict);
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, Merge, action);
}

}  // namespace lowlap::cli
