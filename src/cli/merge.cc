#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/flags/distinct_files.h"
#include "cli/flags/photographs.h"
#include "cli/flags/scene_input.h"
#include "cli/flags/solve_flags.h"
#include "cli/flags/truth.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/merge/merge_models.h"
#include "lowlap/pipeline/internal/output/run_output.h"
#include "third_party_adapters/colmap/internal/database.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

struct MergeFlags {
  CommonFlags common;
  std::vector<std::string> models;
  SceneInputFlags measured;
  std::string database;
  PhotographFlags photographs;
  std::string output;
  SolveFlags solve;
};

// What was measured before.
Result<LoadedScene> Load(const MergeFlags& flags, const ViewCheck& check,
                         const RunContext& context, StageLog* stages) {
  SceneInputFlags measured = flags.measured;
  if (!flags.database.empty()) {
    if (!colmap::IsDatabase(flags.database)) {
      return MakeError(ErrorCode::kInvalidArgument,
                       "--database: there is no COLMAP database",
                       flags.database);
    }
    measured.scene = flags.database;
  }
  return LoadSceneToSolve(measured, flags.solve, context, stages, check);
}

// The measured scene, from photographs or as it was measured before.
Result<Scene> Measure(const MergeFlags& flags, const ViewCheck& check,
                      const RunContext& context, StageLog* stages,
                      RunSummary* summary) {
  if (!flags.measured.scene.empty() || !flags.database.empty()) {
    LOWLAP_ASSIGN_OR_RETURN(auto loaded, Load(flags, check, context, stages));
    summary->pairs = std::move(loaded.pairs);
    return std::move(loaded.scene);
  }
  PhotographFlags photographs = flags.photographs;
  photographs.images = flags.measured.images;
  photographs.exclude = flags.measured.exclude;
  if (photographs.images.empty()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "--images (photographs), --scene (one that was measured) "
                     "or --database (of COLMAP) is missing: the models alone "
                     "do not say how they lie to one another");
  }
  LOWLAP_ASSIGN_OR_RETURN(auto scene, OpenPhotographs(photographs, context));
  LOWLAP_RETURN_IF_ERROR(check(scene));
  LOWLAP_ASSIGN_OR_RETURN(
      auto report,
      MeasurePhotographs(photographs, flags.solve, context, stages, &scene));
  summary->pairs = std::move(report.pairs);
  summary->unrelated = std::move(report.unrelated);
  summary->detected = std::move(report.detected);
  return scene;
}

Result<std::vector<Scene>> ReadModels(const MergeFlags& flags,
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

Result<std::vector<PartialModel>> MatchModels(const MergeFlags& flags,
                                              const std::vector<Scene>& models,
                                              const Scene& measured,
                                              const RunContext& context) {
  std::vector<PartialModel> matched;
  for (std::size_t m = 0; m < models.size(); ++m) {
    LOWLAP_ASSIGN_OR_RETURN(
        auto model, MatchModel(measured, models[m], flags.models[m], context));
    matched.push_back(std::move(model));
  }
  return matched;
}

Result<int> Merge(const MergeFlags& flags) {
  const RunContext context = MakeContext(flags.common);
  // Everything that can be refused is refused before the long work.
  LOWLAP_ASSIGN_OR_RETURN(const auto options, MakeSolveOptions(flags.solve));
  std::vector<NamedFile> inputs = InputFiles(flags.measured);
  for (const std::string& model : flags.models) {
    inputs.push_back({"a model", model});
  }
  LOWLAP_RETURN_IF_ERROR(CheckInputsStay(inputs, flags.output));
  LOWLAP_RETURN_IF_ERROR(CheckOutputFolder(flags.output));
  LOWLAP_ASSIGN_OR_RETURN(const auto scenes, ReadModels(flags, context));
  StageLog stages;
  RunSummary summary;
  summary.command = "merge";
  std::vector<PartialModel> models;
  const auto match = [&](const Scene& views) -> Status {
    LOWLAP_RETURN_IF_ERROR(LoadGroundTruth(flags.solve.ground_truth, views));
    LOWLAP_ASSIGN_OR_RETURN(models, MatchModels(flags, scenes, views, context));
    return {};
  };
  LOWLAP_ASSIGN_OR_RETURN(auto scene,
                          Measure(flags, match, context, &stages, &summary));
  LOWLAP_ASSIGN_OR_RETURN(
      const auto checks, CheckModels(scene, models, options, context, &stages));
  for (std::size_t m = 0; m < models.size(); ++m) {
    for (std::string& line : DescribeCheck(models[m], checks[m], scene)) {
      std::printf("%s\n", line.c_str());
      summary.notes.push_back(std::move(line));
    }
  }
  std::fflush(stdout);  // before what goes to the log
  return SolveAndWrite(std::move(scene), flags.solve, std::move(summary),
                       &stages, context, {}, {flags.output},
                       [&](Scene* measured, const SolveOptions& solve,
                           const RunContext& run, StageLog* log) {
                         return MergeModels(measured, models, checks, solve,
                                            run, log);
                       });
}

}  // namespace

void AddMerge(CLI::App* program, Action* action) {
  auto flags = std::make_shared<MergeFlags>();
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
            "with --database or -m, where their lines are found");
  Option scene =
      AddOption(command, "--scene", flags->measured.scene,
                "A scene that was measured: of 'lowlap run', an OpenMVG "
                "listing with -m, or a COLMAP database");
  Option database = AddOption(command, "--database", flags->database,
                              "A COLMAP database, with its matches")
                        .Excludes(scene);
  Option matches =
      AddOption(command, "-m,--matchdir", flags->measured.matches_dir,
                "OpenMVG matches folder of --scene (.feat and matches.* files)")
          .Needs(scene);
  AddOption(command, "-M,--match_file", flags->measured.match_file,
            "Match file in that folder; default as in OpenMVG")
      .Needs(matches);
  PhotographFlags& photographs = flags->photographs;
  AddIntrinsicsFlags(command, &photographs.intrinsics);
  AddPairsFlag(command, &photographs.pairs, "Pairs of --images to match");
  AddMaxTiltFlag(command, &photographs.choices.max_tilt);
  AddOption(command, "--cache", photographs.cache,
            "Folder of features and matches of --images to use again; without "
            "it none is kept");
  // What was measured before has pairs, matches and intrinsics of its own.
  for (const char* name :
       {"--intrinsics", "--focal", "--pairs", "--max-tilt", "--cache"}) {
    FindOption(command, name).Excludes(scene).Excludes(database);
  }
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
