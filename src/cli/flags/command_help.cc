#include "cli/flags/command_help.h"

#include <CLI/CLI.hpp>

namespace lowlap::cli {
namespace {

// CLI11 shows the type and after it, behind colons, what the checks say: a set
// of words as {one,two}.
void SetValue(const CLI::Option& option, OptionHelp* help) {
  if (option.get_items_expected_max() == 0) return;  // a flag
  const std::string type = option.get_type_name();
  const std::size_t open = type.find('{');
  const std::size_t close = type.rfind('}');
  if (open == std::string::npos || close == std::string::npos) {
    help->value = type;
    return;
  }
  help->words =
      CLI::detail::split(type.substr(open + 1, close - open - 1), ',');
  help->value = CLI::detail::join(help->words, "|");
}

OptionHelp HelpOf(const CLI::Option& option) {
  OptionHelp help;
  for (const std::string& name : option.get_snames()) {
    help.short_names.push_back("-" + name);
  }
  for (const std::string& name : option.get_lnames()) {
    help.long_names.push_back("--" + name);
  }
  if (!option.nonpositional()) help.positional = option.get_name(true);
  SetValue(option, &help);
  help.default_value = option.get_default_str();
  help.text = option.get_description();
  help.is_required = option.get_required();
  help.is_list = option.get_items_expected_max() > 1;
  return help;
}

}  // namespace

std::vector<CommandHelp> HelpOfCommands(const CLI::App& program) {
  std::vector<CommandHelp> commands;
  for (const CLI::App* command : program.get_subcommands({})) {
    CommandHelp& help = commands.emplace_back();
    help.name = command->get_name();
    help.text = command->get_description();
    help.footer = command->get_footer();
    for (const CLI::Option* option : command->get_options()) {
      help.options.push_back(HelpOf(*option));
    }
  }
  return commands;
}

}  // namespace lowlap::cli
