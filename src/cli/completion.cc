#include <cstdio>
#include <memory>

#include "cli/command.h"
#include "cli/flags/command_help.h"
#include "lowlap/core/internal/joined.h"

namespace lowlap::cli {
namespace {

// Within single quotes of a shell.
std::string Quoted(const std::string& text) {
  std::string quoted = "'";
  for (const char c : text) {
    if (c == '\'') {
      quoted += "'\\''";
    } else {
      quoted += c;
    }
  }
  return quoted + "'";
}

std::vector<std::string> AllNames(const OptionHelp& option) {
  std::vector<std::string> names = option.short_names;
  names.insert(names.end(), option.long_names.begin(), option.long_names.end());
  return names;
}

std::string CommandNames(const std::vector<CommandHelp>& commands) {
  return Joined(commands, " ", [](const CommandHelp& c) { return c.name; });
}

std::string BashScript(const std::vector<CommandHelp>& commands) {
  std::string values;
  std::string options;
  for (const CommandHelp& command : commands) {
    std::vector<std::string> names;
    for (const OptionHelp& option : command.options) {
      const std::vector<std::string> own = AllNames(option);
      names.insert(names.end(), own.begin(), own.end());
      if (option.words.empty()) continue;
      // What stands before the value; before the first positional one, the
      // command.
      for (const std::string& before :
           own.empty() ? std::vector<std::string>{command.name} : own) {
        values += "    " + Quoted(command.name + " " + before) +
                  ") words=" + Quoted(Joined(option.words, " ")) + " ;;\n";
      }
    }
    options += "      " + command.name +
               ") words=" + Quoted(Joined(names, " ")) + " ;;\n";
  }
  return "_lowlap() {\n"
         "  local word=${COMP_WORDS[COMP_CWORD]} words=\n"
         "  case \"${COMP_WORDS[1]} ${COMP_WORDS[COMP_CWORD-1]}\" in\n" +
         values +
         "  esac\n"
         "  if ((COMP_CWORD == 1)); then\n"
         "    words=" +
         Quoted(CommandNames(commands)) +
         "\n"
         "  elif [[ -z $words && $word == -* ]]; then\n"
         "    case ${COMP_WORDS[1]} in\n" +
         options +
         "    esac\n"
         "  fi\n"
         "  COMPREPLY=($(compgen -W \"$words\" -- \"$word\"))\n"
         "}\n"
         "complete -o default -F _lowlap lowlap\n";
}

// In a specification of zsh's _arguments.
std::string ZshText(const std::string& text) {
  std::string escaped;
  for (const char c : text) {
    if (c == '[' || c == ']' || c == ':' || c == '\\') escaped += '\\';
    escaped += c == '\n' ? ' ' : c;
  }
  return escaped;
}

std::string ZshScript(const std::vector<CommandHelp>& commands) {
  std::string names;
  std::string cases;
  for (const CommandHelp& command : commands) {
    names += "      " +
             Quoted(ZshText(command.name) + ":" + ZshText(command.text)) + "\n";
    cases += "    " + command.name + ")\n      _arguments";
    for (const OptionHelp& option : command.options) {
      for (const std::string& name : AllNames(option)) {
        std::string spec = "*" + name + "[" + ZshText(option.text) + "]";
        if (!option.words.empty()) {
          spec += ":value:(" + Joined(option.words, " ") + ")";
        } else if (!option.value.empty()) {
          spec += ":" + ZshText(option.value) + ":_files";
        }
        cases += " \\\n        " + Quoted(spec);
      }
    }
    cases += " \\\n        '*:file:_files' ;;\n";
  }
  return "#compdef lowlap\n"
         "_lowlap() {\n"
         "  if ((CURRENT == 2)); then\n"
         "    local -a commands=(\n" +
         names +
         "    )\n"
         "    _describe command commands\n"
         "    return\n"
         "  fi\n"
         "  local command=$words[2]\n"
         "  shift words\n"
         "  ((CURRENT--))\n"
         "  case $command in\n" +
         cases +
         "  esac\n"
         "}\n"
         "_lowlap \"$@\"\n";
}

std::string FishScript(const std::vector<CommandHelp>& commands) {
  std::string script;
  for (const CommandHelp& command : commands) {
    script += "complete -c lowlap -n __fish_use_subcommand -f -a " +
              command.name + " -d " + Quoted(command.text) + "\n";
    for (const OptionHelp& option : command.options) {
      if (!option.positional.empty()) continue;
      script += "complete -c lowlap -n '__fish_seen_subcommand_from " +
                command.name + "'";
      for (const std::string& name : option.short_names) {
        script += " -s " + name.substr(1);
      }
      for (const std::string& name : option.long_names) {
        script += " -l " + name.substr(2);
      }
      if (!option.value.empty()) script += " -r";
      if (!option.words.empty()) {
        script += " -f -a " + Quoted(Joined(option.words, " "));
      }
      script += " -d " + Quoted(option.text) + "\n";
    }
  }
  return script;
}

}  // namespace

void AddCompletion(CLI::App* program, Action* action) {
  auto shell = std::make_shared<std::string>();
  CLI::App* command = AddCommand(
      program, "completion",
      "Print the completion of a shell: source <(lowlap completion bash)");
  AddOption(command, "shell", *shell, "Shell")
      .Required()
      .Must(Check::OneOf({"bash", "zsh", "fish"}));
  WhenChosen(command, [=] {
    *action = [=]() -> Result<int> {
      const std::vector<CommandHelp> commands = HelpOfCommands(*program);
      const std::string script = *shell == "bash"  ? BashScript(commands)
                                 : *shell == "zsh" ? ZshScript(commands)
                                                   : FishScript(commands);
      std::fputs(script.c_str(), stdout);
      return 0;
    };
  });
}

}  // namespace lowlap::cli
