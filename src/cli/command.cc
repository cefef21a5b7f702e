#include "cli/command.h"

#include <unistd.h>

#include <cstdio>

namespace lowlap::cli {

void AddCommonFlags(CLI::App* command, CommonFlags* flags) {
  command
      ->add_option("--threads", flags->threads,
                   "Threads to use; 0 takes all cores")
      ->check(CLI::Range(0, 1024));
  command->add_option("--seed", flags->seed,
                      "Seed of the random draws; the same seed gives the same "
                      "result");
  command->add_flag("-v,--verbose", flags->verbose, "Say more while working");
  command->add_flag("-q,--quiet", flags->quiet, "No progress, no notes");
}

RunContext MakeContext(const CommonFlags& flags) {
  RunContext context;
  context.num_threads = flags.threads;
  context.seed = flags.seed;
  context.log = [flags](LogLevel level, const std::string& message) {
    if (flags.quiet || (level == LogLevel::kDebug && !flags.verbose)) return;
    const char* prefix = level == LogLevel::kWarning ? "warning: " : "";
    std::fprintf(stderr, "%s%s\n", prefix, message.c_str());
  };
  if (!flags.quiet && ::isatty(STDERR_FILENO) != 0) {
    context.progress = [](const std::string& stage, std::size_t done,
                          std::size_t total) {
      std::fprintf(stderr, "\r\033[K%s %zu/%zu", stage.c_str(), done, total);
      if (done == total) std::fprintf(stderr, "\r\033[K");
      std::fflush(stderr);
      return true;
    };
  }
  return context;
}

int Fail(const Error& error) {
  std::fprintf(stderr, "error: %s\n", error.ToString().c_str());
  return 1;
}

}  // namespace lowlap::cli
