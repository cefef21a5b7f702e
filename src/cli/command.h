#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include "cli/flags/command_line.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap::cli {

/// Flags of every command that computes or draws at random.
struct CommonFlags {
  int threads = 0;  // all cores
  std::uint64_t seed = 0;
  bool verbose = false;
  bool quiet = false;
};

void AddCommonFlags(CLI::App* command, CommonFlags* flags);

/// Messages and progress go to standard error, so that standard output holds
/// only the command's result. Progress needs a terminal. An interrupt stops
/// the work at its next step (ErrorCode::kCancelled).
RunContext MakeContext(const CommonFlags& flags);

/// From here on SIGINT and SIGTERM ask the command to stop, whose files then
/// are whole or not there; a second one ends the program at once.
void CatchInterrupts();
bool IsInterrupted();

/// Prints "error: file: place: message" and returns the exit code: 1, or 128 +
/// the signal's number (130 for Ctrl-C) after an interrupt.
int Fail(const Error& error);

/// Exit code of --strict: there is a result, and it is not beyond doubt.
inline constexpr int kNotFirm = 2;

/// What a parsed command line asks for; returns the exit code.
using Action = std::function<Result<int>()>;

/// `action` runs `run` with the flags, if the command is chosen.
template <class Flags>
void RunWhenChosen(CLI::App* command, const std::shared_ptr<Flags>& flags,
                   Result<int> (*run)(const Flags&), Action* action) {
  WhenChosen(command, [=] { *action = [=] { return run(*flags); }; });
}

// Each adds one command to the program; `action` is set if it is chosen.
void AddRun(CLI::App* program, Action* action);
void AddSolve(CLI::App* program, Action* action);
void AddMerge(CLI::App* program, Action* action);
void AddAblate(CLI::App* program, Action* action);
void AddCompare(CLI::App* program, Action* action);
void AddScales(CLI::App* program, Action* action);
void AddAdjust(CLI::App* program, Action* action);
void AddEvaluate(CLI::App* program, Action* action);
void AddFeatures(CLI::App* program, Action* action);
void AddInspect(CLI::App* program, Action* action);
void AddDiagnose(CLI::App* program, Action* action);
void AddDraw(CLI::App* program, Action* action);
void AddSubsets(CLI::App* program, Action* action);
void AddConvert(CLI::App* program, Action* action);
void AddValidate(CLI::App* program, Action* action);
void AddSimulate(CLI::App* program, Action* action);
void AddRobustness(CLI::App* program, Action* action);
void AddManual(CLI::App* program, Action* action);
void AddCompletion(CLI::App* program, Action* action);

}  // namespace lowlap::cli
