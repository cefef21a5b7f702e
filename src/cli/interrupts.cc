#include "cli/interrupts.h"

#include <semaphore.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <mutex>
#include <system_error>
#include <thread>

#include "cli/command.h"
#include "lowlap/core/internal/file_changes.h"

namespace lowlap::cli {
namespace {

// Most steps take less; those of libraries may take seconds.
constexpr std::chrono::milliseconds kPatience{250};

volatile std::sig_atomic_t caught_signal = 0;
sem_t signal_came;
std::atomic<bool> has_ended{false};

// Never destroyed: threads may still work when the program ends.
struct Stage {
  std::mutex mutex;
  std::string name;
};
Stage& CurrentStage() {
  static auto* stage = new Stage;
  return *stage;
}

void OnSignal(int signal) {
  const int errno_before = errno;
  caught_signal = signal;
  constexpr char kMessage[] = "\nstopping\n";
  // Nothing can be done about a failed write.
  [[maybe_unused]] const ssize_t ignored =
      ::write(STDERR_FILENO, kMessage, sizeof kMessage - 1);
  ::sem_post(&signal_came);
  errno = errno_before;
}

void EndAfterInterrupt() {
  while (::sem_wait(&signal_came) != 0) {
  }
  std::this_thread::sleep_for(kPatience);
  EndFileChanges();
  if (has_ended.exchange(true)) return;
  std::fprintf(stderr, "error: interrupted%s; no file is left half-written\n",
               DuringStage().c_str());
  std::_Exit(InterruptExitCode());
}

}  // namespace

void CatchInterrupts() {
  ::sem_init(&signal_came, 0, 0);
  try {
    std::thread(EndAfterInterrupt).detach();
  } catch (const std::system_error&) {
    // Without a thread for it, commands stop at their next step.
  }
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

bool Continue(const std::string& stage) {
  const std::lock_guard<std::mutex> lock(CurrentStage().mutex);
  CurrentStage().name = stage;
  return !IsInterrupted();
}

std::string DuringStage() {
  const std::lock_guard<std::mutex> lock(CurrentStage().mutex);
  const std::string& name = CurrentStage().name;
  return name.empty() ? name : " during " + name;
}

int InterruptExitCode() { return 128 + caught_signal; }

void EndInterrupts() {
  // The program is ending already, elsewhere.
  while (has_ended.exchange(true)) ::pause();
}

}  // namespace lowlap::cli
