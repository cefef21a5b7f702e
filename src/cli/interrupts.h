#pragma once

#include <string>

namespace lowlap::cli {

// With CatchInterrupts and IsInterrupted of command.h: an interrupted command
// stops at its next step. If that takes longer than a quarter of a second, the
// program ends without it: files that are taking their names still do,
// temporary ones are removed.

/// Remembers the stage, for messages; false after an interrupt.
bool Continue(const std::string& stage);

/// " during STAGE", empty before the first one.
std::string DuringStage();

/// 128 + the signal's number: 130 for Ctrl-C.
int InterruptExitCode();

/// The command has ended: no interrupt ends the program any more.
void EndInterrupts();

}  // namespace lowlap::cli
