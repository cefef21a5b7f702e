#include "cli/command.h"

#include <unistd.h>

#include <cstdio>

#include "cli/interrupts.h"
#include "lowlap/core/internal/format.h"

namespace lowlap::cli {

void AddCommonFlags(CLI::App* command, CommonFlags* flags) {
  AddOption(command, "--threads", flags->threads,
            "Threads to use; 0 takes all cores")
      .Must(Check::Between(0, 1024))
      .ShowDefault();
  AddOption(command, "--seed", flags->seed,
            "Seed of the random draws; the same seed gives the same "
            "result")
      .Must(Check::WholeNumber())
      .ShowDefault();
  AddFlag(command, "-v,--verbose", flags->verbose, "Say more while working");
  AddFlag(command, "-q,--quiet", flags->quiet,
          "No progress, no notes; warnings remain");
}

RunContext MakeContext(const CommonFlags& flags) {
  RunContext context;
  context.num_threads = flags.threads;
  context.seed = flags.seed;
  context.log = [flags](LogLevel level, const std::string& message) {
    if (flags.quiet && level != LogLevel::kWarning) return;
    if (level == LogLevel::kDebug && !flags.verbose) return;
    const char* prefix = level == LogLevel::kWarning ? "warning: " : "";
    std::fprintf(stderr, "%s%s\n", prefix, Printable(message).c_str());
  };
  const bool show = !flags.quiet && ::isatty(STDERR_FILENO) != 0;
  context.progress = [show](const std::string& stage, std::size_t done,
                            std::size_t total) {
    if (show) {
      std::fprintf(stderr, "\r\033[K%s %zu/%zu", stage.c_str(), done, total);
      if (done == total) std::fprintf(stderr, "\r\033[K");
      std::fflush(stderr);
    }
    return Continue(stage);
  };
  return context;
}

int Fail(const Error& error) {
  if (IsInterrupted() && error.code == ErrorCode::kCancelled) {
    std::fprintf(stderr, "error: interrupted%s%s; no result is written\n",
                 error.place.empty() ? "" : " during ", error.place.c_str());
    return InterruptExitCode();
  }
  std::fprintf(stderr, "error: %s\n", error.ToString().c_str());
  return 1;
}

}  // namespace lowlap::cli
