#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/scene/validation.h"
#include "third_party_adapters/scene_formats.h"

namespace lowlap::cli {
namespace {

Result<int> Validate(const std::string& path) {
  LOWLAP_ASSIGN_OR_RETURN(const auto scene, ReadScene(path));
  if (Status valid = ValidateScene(scene); !valid) {
    valid.error().file = path;
    return tl::unexpected<Error>(valid.error());
  }
  std::printf("%s: valid, %zu views\n", path.c_str(), scene.views.size());
  return 0;
}

}  // namespace

void AddValidate(CLI::App* program, Action* action) {
  auto path = std::make_shared<std::string>();
  CLI::App* command =
      AddCommand(program, "validate",
                 "Check a scene file; names the first thing that is wrong");
  AddOption(command, "scene", *path, "Scene file").Required();
  RunWhenChosen(command, path, Validate, action);
}

}  // namespace lowlap::cli
