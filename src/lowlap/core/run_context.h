#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>

namespace lowlap {

enum class LogLevel { kDebug, kInfo, kWarning };

/// What a run gets from its host: where messages and progress go, how many
/// threads it may use, and the seed of every random draw. The library itself
/// writes to no stream. Empty sinks are allowed.
struct RunContext {
  using LogSink = std::function<void(LogLevel, const std::string&)>;
  /// Called with (stage, done, total), from one thread at a time; returning
  /// false asks the stage to stop with ErrorCode::kCancelled.
  using ProgressSink =
      std::function<bool(const std::string&, std::size_t, std::size_t)>;

  LogSink log;
  ProgressSink progress;
  int num_threads = 0;  // 0: as many as the machine has cores
  std::uint64_t seed = 0;

  void Log(LogLevel level, const std::string& message) const;
  /// True to go on, false if the host wants to stop.
  bool Progress(const std::string& stage, std::size_t done,
                std::size_t total) const;
  /// num_threads with 0 resolved; at least 1.
  int ThreadCount() const;
};

}  // namespace lowlap
