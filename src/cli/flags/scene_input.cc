#include "cli/flags/scene_input.h"

#include <map>
#include <utility>
#include <vector>

#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/internal/measure/matched_points.h"
#include "third_party_adapters/colmap/internal/database.h"
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

// Features and point matches of another program.
struct Project {
  Scene scene;
  std::map<ViewPair, std::vector<FeatureMatch>> matches;
};

Result<Project> ReadOpenMvg(const SceneInputFlags& flags,
                            const RunContext& context) {
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
  return Project{std::move(project.scene), std::move(project.matches)};
}

Result<Project> ReadColmap(const SceneInputFlags& flags,
                           const RunContext& context) {
  LOWLAP_ASSIGN_OR_RETURN(auto database, colmap::ReadDatabase(flags.scene));
  for (const std::string& note : database.notes) {
    context.Log(LogLevel::kWarning, note);
  }
  return Project{std::move(database.scene), std::move(database.matches)};
}

// Whether there are matches to estimate relative poses from.
bool HoldsMatches(const SceneInputFlags& flags) {
  return !flags.matches_dir.empty() || colmap::IsDatabase(flags.scene);
}

Result<LoadedScene> EstimatePoses(const SceneInputFlags& flags,
                                  const RunContext& context, StageLog* stages,
                                  const ViewCheck& check) {
  LoadedScene loaded;
  MatchedPoints points;
  {
    const StageLog::Scope scope(stages, "import");
    LOWLAP_ASSIGN_OR_RETURN(auto project, flags.matches_dir.empty()
                                              ? ReadColmap(flags, context)
                                              : ReadOpenMvg(flags, context));
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
  if (check) LOWLAP_RETURN_IF_ERROR(check(loaded.scene));
  PhotographUse use = PhotographUse::kNone;
  if (!flags.images.empty()) {
    loaded.scene.root_path = flags.images;
    use = PhotographUse::kLines;
  }
  LOWLAP_ASSIGN_OR_RETURN(
      loaded.pairs, RelateMatchedPoints(points, use, RelativePoseOptions{},
                                        context, stages, &loaded.scene));
  return loaded;
}

Result<LoadedScene> ReadOwnScene(const SceneInputFlags& flags,
                                 const RunContext& context, StageLog* stages,
                                 const ViewCheck& check) {
  const StageLog::Scope scope(stages, "read");
  SceneNotes notes;
  LOWLAP_ASSIGN_OR_RETURN(auto scene, ReadScene(flags.scene, &notes));
  for (const std::string& note : notes) context.Log(LogLevel::kWarning, note);
  LOWLAP_ASSIGN_OR_RETURN(const auto excluded, ExcludedViews(scene, flags));
  if (!excluded.empty()) scene = WithoutViews(scene, excluded);
  if (check) LOWLAP_RETURN_IF_ERROR(check(scene));
  return LoadedScene{std::move(scene), {}};
}

}  // namespace

void AddSceneInputFlags(CLI::App* command, SceneInputFlags* flags) {
  // Required, but the message about it is ours: LoadScene.
  AddOption(command, "scene,-i,--input_file", flags->scene,
            "Scene file (.json, .lowlap, .bin, .xml), a problem "
            "folder of 1DSfM, a database of COLMAP, or an OpenMVG sfm_data "
            "file together with -m; as the first argument or with -i");
  Option matches =
      AddOption(command, "-m,--matchdir,--match_dir", flags->matches_dir,
                "OpenMVG matches folder (.feat and matches.* files)");
  AddOption(command, "-M,--match_file", flags->match_file,
            "Match file in that folder; default as in OpenMVG")
      .Needs(matches);
  AddOption(command, "--images", flags->images,
            "The photographs of a COLMAP database, or of an OpenMVG listing "
            "with -m: lines are detected in them and matched; without it, "
            "points are all there is");
  AddOption(command, "--exclude", flags->exclude,
            "Views to leave out (file names or ids), separated by "
            "commas")
      .SeparatedBy(',');
}

Result<LoadedScene> LoadScene(const SceneInputFlags& flags,
                              const RunContext& context, StageLog* stages,
                              const ViewCheck& check) {
  if (flags.scene.empty()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the scene is missing: first argument, or -i");
  }
  if (HoldsMatches(flags)) return EstimatePoses(flags, context, stages, check);
  if (!flags.images.empty()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "--images goes with matches: a database of COLMAP, or an "
                     "OpenMVG listing and -m",
                     flags.scene);
  }
  return ReadOwnScene(flags, context, stages, check);
}

Result<LoadedScene> LoadMeasuredScene(const SceneInputFlags& flags,
                                      const RunContext& context,
                                      StageLog* stages,
                                      const ViewCheck& check) {
  auto loaded = LoadScene(flags, context, stages, check);
  if (!loaded) return loaded;
  if (loaded->scene.relative_poses.empty()) {
    return MakeError(
        ErrorCode::kInvalidScene,
        HoldsMatches(flags)
            ? ExplainNoPose(loaded->pairs)
            : "holds no relative poses; for an OpenMVG listing give the "
              "matches folder with -m",
        flags.scene);
  }
  return loaded;
}

}  // namespace lowlap::cli
