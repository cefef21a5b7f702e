#include "cli/flags/scene_input.h"

#include "lowlap/core/internal/propagate.h"

namespace lowlap::cli {

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

Result<LoadedScene> LoadSceneToSolve(const SceneInputFlags& flags,
                                     const SolveFlags& solve,
                                     const RunContext& context,
                                     StageLog* stages, const ViewCheck& check) {
  LOWLAP_ASSIGN_OR_RETURN(const auto first, MakeFirstSolution(solve));
  return LoadMeasuredScene(flags, context, stages, check, first);
}

std::vector<NamedFile> InputFiles(const SceneInputFlags& flags) {
  std::vector<NamedFile> files = {{"the scene", flags.scene}};
  if (!flags.matches_dir.empty()) {
    files.push_back(
        {"the listing of the matches", flags.matches_dir + "/sfm_data.json"});
  }
  return files;
}

}  // namespace lowlap::cli
