#include <cstdio>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "cli/command.h"
#include "cli/flags/command_help.h"
#include "lowlap/core/internal/joined.h"
#include "lowlap/core/internal/propagate.h"
#include "lowlap/pipeline/internal/output/output_folder.h"

namespace lowlap::cli {
namespace {

// Text as troff reads it: no escapes, no requests, hyphens that can be copied.
std::string Roff(const std::string& text) {
  std::string roff;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const bool starts_line = n == 0 || text[n - 1] == '\n';
    if (starts_line && (text[n] == '.' || text[n] == '\'')) roff += "\\&";
    if (text[n] == '\\') {
      roff += "\\e";
    } else if (text[n] == '-') {
      roff += "\\-";
    } else {
      roff += text[n];
    }
  }
  return roff;
}

std::string Bold(const std::string& text) {
  return "\\fB" + Roff(text) + "\\fR";
}

std::string Italic(const std::string& text) {
  return "\\fI" + Roff(text) + "\\fR";
}

std::string NamesOf(const OptionHelp& option) {
  if (!option.positional.empty()) return Italic(option.positional);
  std::vector<std::string> names = option.short_names;
  names.insert(names.end(), option.long_names.begin(), option.long_names.end());
  std::string text = Joined(names, ", ", Bold);
  if (!option.value.empty()) text += " " + Italic(option.value);
  return text;
}

std::string Synopsis(const CommandHelp& command) {
  std::string text =
      Bold("lowlap " + command.name) + " [" + Italic("options") + "]";
  for (const OptionHelp& option : command.options) {
    if (option.positional.empty()) {
      if (option.is_required) text += " " + NamesOf(option);
      continue;
    }
    const std::string name = NamesOf(option) + (option.is_list ? "..." : "");
    text += option.is_required ? " " + name : " [" + name + "]";
  }
  return text;
}

std::string Header(const std::string& name, const std::string& text) {
  return ".TH \"" + name +
         "\" 1 \"\" \"lowlap " LOWLAP_VERSION
         "\" \"lowlap manual\"\n.SH NAME\n" +
         Roff(name) + " \\- " + Roff(text) + "\n";
}

constexpr char kExitStatus[] = R"(.SH EXIT STATUS
.TP
0
There is a result.
.TP
1
There is none; an error message says why, with file and place.
.TP
2
With \fB\-\-strict\fR: there is a result, and it is not beyond doubt.
.TP
100 and above
The command line is wrong; after Ctrl\-C, 130.
)";

std::string PageOf(const CommandHelp& command) {
  std::string page = Header("lowlap-" + command.name, command.text);
  page += ".SH SYNOPSIS\n" + Synopsis(command) + "\n.SH OPTIONS\n";
  for (const OptionHelp& option : command.options) {
    page += ".TP\n" + NamesOf(option) + "\n" + Roff(option.text) + ".";
    if (!option.default_value.empty()) {
      page += " Default: " + Roff(option.default_value) + ".";
    }
    page += "\n";
  }
  if (!command.footer.empty()) {
    page += ".SH NOTES\n.nf\n" + Roff(command.footer) + "\n.fi\n";
  }
  return page + kExitStatus + ".SH SEE ALSO\n" + Bold("lowlap") + "(1)\n";
}

std::string PageOfProgram(const std::vector<CommandHelp>& commands) {
  std::string page =
      Header("lowlap", "calibrates photographs that hardly overlap");
  page += ".SH SYNOPSIS\n" + Bold("lowlap") + " " + Italic("command") + " [" +
          Italic("options") + "]\n.SH COMMANDS\n";
  for (const CommandHelp& command : commands) {
    page += ".TP\n" + Bold("lowlap-" + command.name) + "(1)\n" +
            Roff(command.text) + ".\n";
  }
  return page + kExitStatus;
}

struct ManualFlags {
  std::string command;
  std::string folder;
};

Result<int> Print(const CLI::App& program, const ManualFlags& flags) {
  const std::vector<CommandHelp> commands = HelpOfCommands(program);
  if (!flags.folder.empty()) {
    std::vector<std::pair<std::string, std::string>> pages = {
        {"lowlap.1", PageOfProgram(commands)}};
    for (const CommandHelp& command : commands) {
      pages.emplace_back("lowlap-" + command.name + ".1", PageOf(command));
    }
    LOWLAP_RETURN_IF_ERROR(WriteTextFiles(pages, flags.folder));
    return 0;
  }
  std::string page;
  if (flags.command.empty()) page = PageOfProgram(commands);
  for (const CommandHelp& command : commands) {
    if (command.name == flags.command) page = PageOf(command);
  }
  if (page.empty()) {
    return MakeError(ErrorCode::kInvalidArgument,
                     "there is no command '" + flags.command + "'");
  }
  std::fputs(page.c_str(), stdout);
  return 0;
}

}  // namespace

void AddManual(CLI::App* program, Action* action) {
  auto flags = std::make_shared<ManualFlags>();
  CLI::App* command = AddCommand(
      program, "manual", "Print a manual page: lowlap manual solve | man -l -");
  const Option name = AddOption(command, "command", flags->command,
                                "Command; without, the program's page");
  AddOption(command, "--output", flags->folder,
            "Write the pages of the program and of all commands to this folder")
      .Excludes(name);
  WhenChosen(command,
             [=] { *action = [=] { return Print(*program, *flags); }; });
}

}  // namespace lowlap::cli
