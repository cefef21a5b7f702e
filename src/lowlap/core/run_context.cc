#include "lowlap/core/run_context.h"

#include <algorithm>
#include <thread>

namespace lowlap {

void RunContext::Log(LogLevel level, const std::string& message) const {
  if (log) log(level, message);
}

bool RunContext::Progress(const std::string& stage, std::size_t done,
                          std::size_t total) const {
  return !progress || progress(stage, done, total);
}

int RunContext::ThreadCount() const {
  if (num_threads > 0) return num_threads;
  return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
}

}  // namespace lowlap
