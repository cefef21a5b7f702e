// Manual pages and completion, which the program writes about itself.
#include <gtest/gtest.h>

#include <cstdlib>
#include <sstream>
#include <string>
#include <vector>

#include "cli/cli_fixture.h"

namespace lowlap {
namespace {

// The commands that `lowlap --help` lists.
std::vector<std::string> Commands() {
  std::istringstream help(Lowlap("--help").output);
  std::vector<std::string> commands;
  std::string line;
  bool in_list = false;
  while (std::getline(help, line)) {
    if (line.rfind("Subcommands:", 0) == 0) {
      in_list = true;
    } else if (in_list && line.rfind("  ", 0) == 0 && line[2] != ' ') {
      commands.push_back(line.substr(2, line.find(' ', 2) - 2));
    }
  }
  return commands;
}

bool HasTool(const std::string& name) {
  return std::system(("command -v " + name + " >/dev/null").c_str()) == 0;
}

// What `bash` completes the last of the words to.
std::string Completed(const std::string& script, const std::string& words,
                      int index) {
  const std::string line = "bash -c 'source " + script + "; COMP_WORDS=(" +
                           words + "); COMP_CWORD=" + std::to_string(index) +
                           "; _lowlap; echo \"${COMPREPLY[@]}\"'";
  FILE* pipe = ::popen(line.c_str(), "r");
  std::string text;
  for (int c; (c = std::fgetc(pipe)) != EOF;) text += static_cast<char>(c);
  ::pclose(pipe);
  return text;
}

class Help : public Cli {};

TEST_F(Help, EveryCommandHasAManualPage) {
  const std::vector<std::string> commands = Commands();
  ASSERT_GE(commands.size(), 18U);
  ASSERT_EQ(Lowlap("manual --output " + Path("")).exit_code, 0);
  const std::string program = ReadText(Path("lowlap.1"));
  for (const std::string& command : commands) {
    EXPECT_NE(program.find("\\fBlowlap\\-" + command + "\\fR(1)"),
              std::string::npos)
        << command;
    const std::string page = ReadText(Path("lowlap-" + command + ".1"));
    EXPECT_EQ(page, Lowlap("manual " + command).output);
    EXPECT_NE(page.find(".SH SYNOPSIS"), std::string::npos) << command;
  }
}

TEST_F(Help, TroffReadsThePagesWithoutAWarning) {
  if (!HasTool("groff")) GTEST_SKIP() << "skipped: no groff";
  ASSERT_EQ(Lowlap("manual --output " + Path("")).exit_code, 0);
  const std::string warnings = Path("warnings");
  ASSERT_EQ(std::system(
                ("groff -man -Tutf8 -ww -z " + Path("") + "*.1 2> " + warnings)
                    .c_str()),
            0);
  EXPECT_EQ(ReadText(warnings), "");
}

TEST_F(Help, ManualMakesItsFolder) {
  const Outcome outcome = Lowlap("manual --output " + Path("new/man1"));
  EXPECT_EQ(outcome.exit_code, 0) << outcome.output;
  EXPECT_EQ(FilesIn("new/man1"), Commands().size() + 1);
}

TEST_F(Help, ManualOfNoCommandIsAnError) {
  const Outcome outcome = Lowlap("manual slove");
  EXPECT_EQ(outcome.exit_code, 1);
  EXPECT_NE(outcome.output.find("'slove'"), std::string::npos);
}

TEST_F(Help, BashCompletesCommandsOptionsAndValues) {
  Write("script", Lowlap("completion bash").output);
  EXPECT_EQ(Completed(Path("script"), "lowlap compl", 1), "completion\n");
  EXPECT_EQ(Completed(Path("script"), "lowlap run --intri", 2),
            "--intrinsics\n");
  EXPECT_EQ(Completed(Path("script"), "lowlap completion b", 2), "bash\n");
  EXPECT_EQ(Completed(Path("script"), "lowlap run --matcher f", 3), "flann\n");
  const std::string options = Completed(Path("script"), "lowlap solve --", 2);
  EXPECT_NE(options.find("--images"), std::string::npos);
  EXPECT_NE(options.find("--strict"), std::string::npos);
}

TEST_F(Help, ShellsReadTheirScripts) {
  for (const std::string shell : {"bash", "zsh", "fish"}) {
    const Outcome script = Lowlap("completion " + shell);
    EXPECT_EQ(script.exit_code, 0);
    for (const std::string& command : Commands()) {
      EXPECT_NE(script.output.find(command), std::string::npos) << command;
    }
    if (!HasTool(shell)) continue;
    Write("script", script.output);
    EXPECT_EQ(std::system((shell + " -n " + Path("script")).c_str()), 0)
        << shell;
  }
  EXPECT_NE(Lowlap("completion csh").exit_code, 0);
}

}  // namespace
}  // namespace lowlap
