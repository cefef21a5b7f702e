#pragma once

#include <CLI/CLI.hpp>
#include <cstdint>
#include <functional>
#include <string>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap::cli {

/// Flags that every command has.
struct CommonFlags {
  int threads = 0;
  std::uint64_t seed = 0;
  bool verbose = false;
  bool quiet = false;
};

void AddCommonFlags(CLI::App* command, CommonFlags* flags);

/// Messages and progress go to standard error, so that standard output holds
/// only the command's result. Progress needs a terminal.
RunContext MakeContext(const CommonFlags& flags);

/// Prints "error: file: place: message" and returns the exit code 1.
int Fail(const Error& error);

/// What a parsed command line asks for; returns the exit code.
using Action = std::function<int()>;

// Each adds one command to the program; `action` is set if it is chosen.
void AddRun(CLI::App* program, Action* action);
void AddSolve(CLI::App* program, Action* action);
void AddScales(CLI::App* program, Action* action);
void AddAdjust(CLI::App* program, Action* action);
void AddEvaluate(CLI::App* program, Action* action);
void AddInspect(CLI::App* program, Action* action);
void AddConvert(CLI::App* program, Action* action);
void AddValidate(CLI::App* program, Action* action);
void AddSimulate(CLI::App* program, Action* action);

}  // namespace lowlap::cli
