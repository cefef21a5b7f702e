#include "third_party_adapters/internal/scene_input.h"

#include <map>
#include <utility>
#include <vector>

#include "lowlap/adjustment/internal/intrinsic_refinement.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/image_collection.h"
#include "lowlap/pipeline/internal/measure/calibration_fit.h"
#include "lowlap/pipeline/internal/measure/matched_points.h"
#include "third_party_adapters/colmap/internal/database.h"
#include "third_party_adapters/openmvg/internal/import.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap {
namespace {

// The views that `exclude` names.
Result<std::vector<ViewId>> ExcludedViews(const Scene& scene,
                                          const SceneInput& input) {
  auto excluded = FindViews(scene, input.exclude);
  if (!excluded) excluded.error().file = input.scene;
  return excluded;
}

void WarnOfFocals(const Scene& scene, const RunContext& context) {
  if (const auto warning = ImplausibleFocals(scene)) {
    context.Log(LogLevel::kWarning, *warning);
  }
}

// Features and point matches of another program.
struct Project {
  Scene scene;
  std::map<ViewPair, std::vector<FeatureMatch>> matches;
};

Result<Project> ReadOpenMvg(const SceneInput& input,
                            const RunContext& context) {
  openmvg::ImportOptions options;
  options.match_file = input.match_file;
  LOWLAP_ASSIGN_OR_RETURN(
      auto project,
      openmvg::ImportProject(input.scene, input.matches_dir, options));
  context.Log(LogLevel::kInfo, "matches from " + project.match_file);
  if (project.num_dropped_pairs > 0) {
    context.Log(LogLevel::kInfo,
                std::to_string(project.num_dropped_pairs) +
                    " pairs name views that the listing does not have");
  }
  return Project{std::move(project.scene), std::move(project.matches)};
}

Result<Project> ReadColmap(const SceneInput& input, const RunContext& context) {
  LOWLAP_ASSIGN_OR_RETURN(auto database, colmap::ReadDatabase(input.scene));
  for (const std::string& note : database.notes) {
    context.Log(LogLevel::kWarning, note);
  }
  return Project{std::move(database.scene), std::move(database.matches)};
}

// Whether there are matches to estimate relative poses from.
bool HoldsMatches(const SceneInput& input) {
  return !input.matches_dir.empty() || colmap::IsDatabase(input.scene);
}

Result<LoadedScene> EstimatePoses(const SceneInput& input,
                                  const RunContext& context, StageLog* stages,
                                  const ViewCheck& check,
                                  const FirstSolution& first) {
  LoadedScene loaded;
  MatchedPoints points;
  {
    const StageLog::Scope scope(stages, "import");
    LOWLAP_ASSIGN_OR_RETURN(auto project, input.matches_dir.empty()
                                              ? ReadColmap(input, context)
                                              : ReadOpenMvg(input, context));
    LOWLAP_ASSIGN_OR_RETURN(const auto excluded,
                            ExcludedViews(project.scene, input));
    loaded.scene = WithoutViews(project.scene, excluded);
    for (auto& [views, matches] : project.matches) {
      if (loaded.scene.views.count(views.first) > 0 &&
          loaded.scene.views.count(views.second) > 0) {
        points.matches[views] = std::move(matches);
      }
    }
  }
  WarnOfFocals(loaded.scene, context);
  if (check) LOWLAP_RETURN_IF_ERROR(check(loaded.scene));
  PhotographUse use = PhotographUse::kNone;
  if (!input.images.empty()) {
    loaded.scene.root_path = input.images;
    use = PhotographUse::kLines;
  }
  LOWLAP_ASSIGN_OR_RETURN(
      loaded.pairs, RelateMatchedPoints(points, use, RelativePoseOptions{},
                                        first, context, stages, &loaded.scene));
  return loaded;
}

Result<LoadedScene> ReadOwnScene(const SceneInput& input,
                                 const RunContext& context, StageLog* stages,
                                 const ViewCheck& check) {
  const StageLog::Scope scope(stages, "read");
  SceneNotes notes;
  LOWLAP_ASSIGN_OR_RETURN(auto scene, ReadScene(input.scene, &notes));
  for (const std::string& note : notes) context.Log(LogLevel::kWarning, note);
  LOWLAP_ASSIGN_OR_RETURN(const auto excluded, ExcludedViews(scene, input));
  if (!excluded.empty()) scene = WithoutViews(scene, excluded);
  WarnOfFocals(scene, context);
  if (check) LOWLAP_RETURN_IF_ERROR(check(scene));
  return LoadedScene{std::move(scene), {}};
}

}  // namespace

Result<LoadedScene> LoadScene(const SceneInput& input,
                              const RunContext& context, StageLog* stages,
                              const ViewCheck& check,
                              const FirstSolution& first) {
  if (input.scene.empty()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "the scene is missing: first argument, or -i");
  }
  if (HoldsMatches(input)) {
    return EstimatePoses(input, context, stages, check, first);
  }
  if (!input.images.empty()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "--images goes with matches: a database of COLMAP, or an "
                     "OpenMVG listing and -m",
                     input.scene);
  }
  return ReadOwnScene(input, context, stages, check);
}

Result<LoadedScene> LoadMeasuredScene(const SceneInput& input,
                                      const RunContext& context,
                                      StageLog* stages, const ViewCheck& check,
                                      const FirstSolution& first) {
  auto loaded = LoadScene(input, context, stages, check, first);
  if (!loaded) return loaded;
  if (loaded->scene.relative_poses.empty()) {
    return MakeError(ErrorCode::kInvalidScene,
                     HoldsMatches(input) ? ExplainNoPose(loaded->pairs)
                     : !input.exclude.empty()
                         ? "holds no relative poses without the excluded views"
                         : "holds no relative poses; for an OpenMVG listing "
                           "give the matches folder with -m",
                     input.scene);
  }
  RestoreGivenIntrinsics(&loaded->scene);
  return loaded;
}

}  // namespace lowlap
