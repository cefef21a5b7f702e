#include <CLI/CLI.hpp>
#include <atomic>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <new>
#include <string>
#include <system_error>
#include <vector>

#include "cli/command.h"
#include "cli/flags/solve_flags.h"
#include "cli/interrupts.h"

namespace {

bool HasCommand(const CLI::App& program, const std::string& name) {
  for (const CLI::App* command : program.get_subcommands({})) {
    if (command->check_name(name)) return true;
  }
  return false;
}

std::atomic<bool> memory_ran_out{false};
const std::terminate_handler kTerminateBefore = std::get_terminate();

void OnNoMemory() {
  memory_ran_out = true;
  throw std::bad_alloc();
}

// Libraries that cannot do with an exception (Ceres) end up here.
[[noreturn]] void OnTerminate() {
  if (!memory_ran_out) {
    kTerminateBefore();
    std::abort();
  }
  std::fputs("error: memory ran out\n", stderr);
  std::_Exit(1);
}

// What was printed is a result, too: a full disk must not pass unnoticed.
bool IsPrinted() {
  if (std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return true;
  std::fprintf(stderr, "error: standard output cannot be written: %s\n",
               std::generic_category().message(errno).c_str());
  return false;
}

int Run(const lowlap::cli::Action& action) {
  try {
    const lowlap::Result<int> exit_code = action();
    if (!exit_code) return lowlap::cli::Fail(exit_code.error());
    return IsPrinted() ? *exit_code : 1;
  } catch (const std::bad_alloc&) {
    std::fprintf(stderr, "error: memory ran out%s\n",
                 lowlap::cli::DuringStage().c_str());
  } catch (const std::exception& exception) {
    // The library reports other errors as values.
    std::fprintf(stderr, "error: %s\n", exception.what());
  }
  return 1;
}

}  // namespace

// OnTerminate has the last word. NOLINTNEXTLINE(bugprone-exception-escape)
int main(int argc, char** argv) {
  CLI::App program{
      "lowlap calibrates photographs that hardly overlap: it finds the "
      "relative scale of\n"
      "neighbouring relative poses from coplanar lines and from trifocal "
      "points and lines,\n"
      "composes camera poses, and refines them by bundle adjustment."};
  program.set_version_flag("--version", LOWLAP_VERSION);
  program.require_subcommand(1);
  program.footer("'lowlap COMMAND --help' explains a command.");

  lowlap::cli::Action action;
  lowlap::cli::AddRun(&program, &action);
  lowlap::cli::AddSolve(&program, &action);
  lowlap::cli::AddMerge(&program, &action);
  lowlap::cli::AddCompare(&program, &action);
  lowlap::cli::AddAblate(&program, &action);
  lowlap::cli::AddScales(&program, &action);
  lowlap::cli::AddAdjust(&program, &action);
  lowlap::cli::AddEvaluate(&program, &action);
  lowlap::cli::AddFeatures(&program, &action);
  lowlap::cli::AddDraw(&program, &action);
  lowlap::cli::AddInspect(&program, &action);
  lowlap::cli::AddDiagnose(&program, &action);
  lowlap::cli::AddSubsets(&program, &action);
  lowlap::cli::AddConvert(&program, &action);
  lowlap::cli::AddValidate(&program, &action);
  lowlap::cli::AddSimulate(&program, &action);
  lowlap::cli::AddRobustness(&program, &action);
  lowlap::cli::AddManual(&program, &action);
  lowlap::cli::AddCompletion(&program, &action);

  if (argc > 1 && argv[1][0] != '-' && !HasCommand(program, argv[1])) {
    std::fprintf(stderr,
                 "there is no command '%s'; 'lowlap --help' lists them\n",
                 argv[1]);
    return static_cast<int>(CLI::ExitCodes::ExtrasError);
  }
  const std::vector<std::string> arguments =
      lowlap::cli::WithRefinedParts({argv, argv + argc});
  std::vector<const char*> words;
  words.reserve(arguments.size());
  for (const std::string& argument : arguments) {
    words.push_back(argument.c_str());
  }
  CLI11_PARSE(program, argc, words.data());
  lowlap::cli::CatchInterrupts();
  std::set_new_handler(OnNoMemory);
  std::set_terminate(OnTerminate);
  const int exit_code = Run(action);
  lowlap::cli::EndInterrupts();
  return exit_code;
}
