#include <cstdio>
#include <memory>
#include <optional>

#include "cli/command.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/scene_reduction.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

struct ConvertFlags {
  CommonFlags common;
  std::string input;
  std::string output;
  std::string input_format;
  std::string output_format;
  bool lists_formats = false;
  bool drop_solution = false;
  int max_point_matches = 0;
  std::optional<std::string> root_path;
};

Result<int> Convert(const ConvertFlags& flags) {
  if (flags.lists_formats) {
    std::fputs(TabulateSceneFormats(AllSceneFormats()).c_str(), stdout);
    return 0;
  }
  if (flags.input.empty() || flags.output.empty()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "convert needs a file to read and one to write");
  }
  LOWLAP_RETURN_IF_ERROR(CheckScenePlace(flags.output, flags.output_format));
  SceneNotes notes;
  LOWLAP_ASSIGN_OR_RETURN(auto scene,
                          ReadScene(flags.input, &notes, flags.input_format));
  if (flags.drop_solution) DropSolution(&scene);
  if (flags.max_point_matches > 0) {
    LOWLAP_RETURN_IF_ERROR(LimitPointMatches(flags.max_point_matches, &scene));
  }
  if (flags.root_path) scene.root_path = *flags.root_path;
  LOWLAP_ASSIGN_OR_RETURN(const auto written,
                          WriteScene(scene, flags.output, flags.output_format));
  notes.insert(notes.end(), written.begin(), written.end());
  if (scene.relative_poses.empty() &&
      (flags.drop_solution || flags.max_point_matches > 0)) {
    notes.push_back(
        "without its solution the scene holds no measurements, only views and "
        "intrinsics");
  }
  const RunContext context = MakeContext(flags.common);
  for (const std::string& note : notes) context.Log(LogLevel::kWarning, note);
  return 0;
}

}  // namespace

void AddConvert(CLI::App* program, Action* action) {
  auto flags = std::make_shared<ConvertFlags>();
  CLI::App* command =
      AddCommand(program, "convert", "Convert a scene file to another format");
  AddOption(command, "input", flags->input, "Scene file to read");
  AddOption(command, "output", flags->output,
            "File or folder to write; its extension names the format");
  AddOption(command, "--from", flags->input_format,
            "Format to read, where neither content nor extension tells it");
  AddOption(command, "--to", flags->output_format,
            "Format to write, where the extension is not enough");
  AddFlag(command, "--formats", flags->lists_formats,
          "List the formats and what each holds, and do nothing else");
  AddFlag(command, "--drop-solution", flags->drop_solution,
          "Keep what was measured, drop ratios, poses and structure");
  AddOption(command, "--max-point-matches", flags->max_point_matches,
            "Keep at most this many point matches of each pair, those "
            "on the longest tracks first, and drop the solution")
      .Must(Check::Positive());
  AddOption(command, "--root-path", flags->root_path,
            "Image folder to write into the scene, where the images "
            "have moved");
  SetFooter(command, "Formats:\n" + DescribeSceneFormats(AllSceneFormats()));
  AddCommonFlags(command, &flags->common);
  RunWhenChosen(command, flags, Convert, action);
}

}  // namespace lowlap::cli
