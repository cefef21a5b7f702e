#include "cli/command.h"

#include <unistd.h>

#include <csignal>
#include <cstdio>

#include "lowlap/core/internal/format.h"

namespace lowlap::cli {
namespace {

volatile std::sig_atomic_t caught_signal = 0;

void OnSignal(int signal) {
  caught_signal = signal;
  constexpr char kMessage[] =
      "\nstopping after the step at work; once more to stop at once\n";
  // Nothing can be done about a failed write.
  [[maybe_unused]] const ssize_t ignored =
      ::write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
}

}  // namespace

void CatchInterrupts() {
  struct sigaction action {};
  action.sa_handler = OnSignal;
  action.sa_flags = static_cast<int>(SA_RESTART | SA_RESETHAND);
  for (const int signal : {SIGINT, SIGTERM}) {
    // Ignored from outside, as in a job in the background, it stays ignored.
    struct sigaction inherited {};
    ::sigaction(signal, nullptr, &inherited);
    if (inherited.sa_handler != SIG_IGN) ::sigaction(signal, &action, nullptr);
  }
}

bool IsInterrupted() { return caught_signal != 0; }

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
  AddFlag(command, "-q,--quiet", flags->quiet, "No progress, no notes");
}

RunContext MakeContext(const CommonFlags& flags) {
  RunContext context;
  context.num_threads = flags.threads;
  context.seed = flags.seed;
  context.log = [flags](LogLevel level, const std::string& message) {
    if (flags.quiet || (level == LogLevel::kDebug && !flags.verbose)) return;
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
    return !IsInterrupted();
  };
  return context;
}

int Fail(const Error& error) {
  if (IsInterrupted() && error.code == ErrorCode::kCancelled) {
    std::fprintf(stderr, "error: interrupted%s%s; no result is written\n",
                 error.place.empty() ? "" : " during ", error.place.c_str());
    return 128 + caught_signal;
  }
  std::fprintf(stderr, "error: %s\n", error.ToString().c_str());
  return 1;
}

}  // namespace lowlap::cli
