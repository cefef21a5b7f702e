#include <memory>

#include "cli/command.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

struct Flags {
  CommonFlags common;
  std::string input;
  std::string output;
  std::string format;
};

int Convert(const Flags& flags) {
  const auto scene = ReadScene(flags.input);
  if (!scene) return Fail(scene.error());
  const auto notes = WriteScene(*scene, flags.output, flags.format);
  if (!notes) return Fail(notes.error());
  const RunContext context = MakeContext(flags.common);
  for (const std::string& note : *notes) {
    context.Log(LogLevel::kWarning, note);
  }
  return 0;
}

}  // namespace

void AddConvert(CLI::App* program, Action* action) {
  auto flags = std::make_shared<Flags>();
  CLI::App* command = program->add_subcommand(
      "convert", "Convert a scene file to another format");
  command->add_option("input", flags->input, "Scene file to read")->required();
  command
      ->add_option("output", flags->output,
                   "File to write; its extension names the format")
      ->required();
  command->add_option("--to", flags->format,
                      "Format to write, where the extension is not enough");
  command->footer("Formats:\n" + DescribeSceneFormats());
  AddCommonFlags(command, &flags->common);
  command->callback(
      [flags, action] { *action = [flags] { return Convert(*flags); }; });
}

}  // namespace lowlap::cli
