#pragma once

#include <string>
#include <vector>

namespace CLI {
class App;
}  // namespace CLI

namespace lowlap::cli {

/// What the help of a command says, for manual pages and completion.
struct OptionHelp {
  std::vector<std::string> short_names;  // -v
  std::vector<std::string> long_names;   // --verbose
  std::string positional;                // the name, where it has no other
  std::string value;                     // empty if it takes none
  std::vector<std::string> words;        // all values there are, if few
  std::string default_value;
  std::string text;
  bool is_required = false;
  bool is_list = false;
};

struct CommandHelp {
  std::string name;
  std::string text;
  std::string footer;
  std::vector<OptionHelp> options;
};

/// Of every command, in the order of `lowlap --help`.
std::vector<CommandHelp> HelpOfCommands(const CLI::App& program);

}  // namespace lowlap::cli
