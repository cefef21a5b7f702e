#include "cli/scene_input.h"

#include <filesystem>
#include <system_error>
#include <utility>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/internal/measure/matched_points.h"
#include "third_party_adapters/openmvg/internal/import.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

// The views that --exclude names.
Result<std::vector<ViewId>> ExcludedViews(const Scene& scene,
                                          const SceneInputFlags& flags) {
  auto excluded = FindViews(scene, flags.exclude);
  if (!excluded) excluded.error().file = flags.scene;
  return excluded;
}

// A relative root path is meant from here, as OpenMVG reads it, or from the
// listing's folder.
void FindPhotographs(const std::string& listing, Scene* scene) {
  namespace fs = std::filesystem;
  const fs::path root(scene->root_path);
  std::error_code ignored;
  if (root.is_absolute() || fs::is_directory(root, ignored)) return;
  const fs::path beside = fs::path(listing).parent_path() / root;
  if (fs::is_directory(beside, ignored)) scene->root_path = beside.string();
}

Result<LoadedScene> ImportOpenMvg(const SceneInputFlags& flags,
                                  const RunContext& context, StageLog* stages) {
  LoadedScene loaded;
  MatchedPoints points;
  {
    const StageLog::Scope scope(stages, "import");
    openmvg::ImportOptions options;
    options.match_file = flags.match_file;
    LOWLAP_ASSIGN_OR_RETURN(
        auto project,
        openmvg::ImportProject(flags.scene, flags.matches_dir, options));
    context.Log(LogLevel::kInfo, "matches from " + project.match_file);
    if (project.num_dropped_pairs > 0) {
      context.Log(LogLevel::kInfo,
                  std::to_string(project.num_dropped_pairs) +
                      " pairs name views that the listing does not have");
    }
    LOWLAP_ASSIGN_OR_RETURN(const auto excluded,
                            ExcludedViews(project.scene, flags));
    loaded.scene = WithoutViews(project.scene, excluded);
    for (auto& [views, matches] : project.matches) {
      if (loaded.scene.views.count(views.first) > 0 &&
          loaded.scene.views.count(views.second) > 0) {
        points.matches[views] = std::move(matches);
      }
    }
  }
  if (flags.image_lines) FindPhotographs(flags.scene, &loaded.scene);
  LOWLAP_ASSIGN_OR_RETURN(
      loaded.pairs,
      RelateMatchedPoints(
          points,
          flags.image_lines ? PhotographUse::kLines : PhotographUse::kNone,
          RelativePoseOptions{}, context, stages, &loaded.scene));
  return loaded;
}

Result<LoadedScene> ReadOwnScene(const SceneInputFlags& flags,
                                 const RunContext& context, StageLog* stages) {
  const StageLog::Scope scope(stages, "read");
  SceneNotes notes;
  LOWLAP_ASSIGN_OR_RETURN(auto scene, ReadScene(flags.scene, &notes));
  for (const std::string& note : notes) context.Log(LogLevel::kWarning, note);
  LOWLAP_ASSIGN_OR_RETURN(const auto excluded, ExcludedViews(scene, flags));
  return LoadedScene{
      excluded.empty() ? std::move(scene) : WithoutViews(scene, excluded), {}};
}

}  // namespace

void AddSceneInputFlags(CLI::App* command, SceneInputFlags* flags) {
  // Required, but the message about it is ours: LoadScene.
  AddOption(command, "scene,-i,--input_file", flags->scene,
            "Scene file (.json, .lowlap, .bin, .xml), a problem "
            "folder of 1DSfM, or an OpenMVG sfm_data file together "
            "with -m; as the first argument or with -i");
  Option matches =
      AddOption(command, "-m,--matchdir,--match_dir", flags->matches_dir,
                "OpenMVG matches folder (.feat and matches.* files)");
  AddOption(command, "-M,--match_file", flags->match_file,
            "Match file in that folder; default as in OpenMVG")
      .Needs(matches);
  AddFlag(command, "--image-lines", flags->image_lines,
          "Of an OpenMVG project: lines as well, detected and matched in the "
          "photographs that are found below its root path")
      .Needs(matches);
  AddOption(command, "--exclude", flags->exclude,
            "Views to leave out (file names or ids), separated by "
            "commas")
      .SeparatedBy(',');
}

Result<LoadedScene> LoadScene(const SceneInputFlags& flags,
                              const RunContext& context, StageLog* stages) {
  if (flags.scene.empty()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the scene is missing: first argument, or -i");
  }
  return flags.matches_dir.empty() ? ReadOwnScene(flags, context, stages)
                                   : ImportOpenMvg(flags, context, stages);
}

Result<LoadedScene> LoadMeasuredScene(const SceneInputFlags& flags,
                                      const RunContext& context,
                                      StageLog* stages) {
  auto loaded = LoadScene(flags, context, stages);
  if (!loaded) return loaded;
  if (loaded->scene.relative_poses.empty()) {
    return MakeError(
        ErrorCode::kInvalidScene,
        flags.matches_dir.empty()
            ? "holds no relative poses; for an OpenMVG listing give the "
              "matches folder with -m"
            : ExplainNoPose(loaded->pairs),
        flags.scene);
  }
  return loaded;
}

}  // namespace lowlap::cli
