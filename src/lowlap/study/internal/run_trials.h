#pragma once

#include <functional>
#include <map>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include "lowlap/core/internal/parallel.h"
#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// Runs the trials of `keys` on the context's threads, each on one of them, and
/// adds them to `trials`. A trial depends on its key alone, so that the result
/// is the same for any number of threads. `run` gives nothing where it was
/// cancelled; `done` (may be empty) is told each trial when it is there, from
/// one thread at a time, in no fixed order. Errors: those of `done`,
/// kCancelled; then `trials` holds what was done.
template <class Key, class Trial>
Status RunTrials(const RunContext& context, const std::string& stage,
                 const std::vector<Key>& keys,
                 const std::function<std::optional<Trial>(const Key&)>& run,
                 const std::function<Status(const Key&, const Trial&)>& done,
                 std::map<Key, Trial>* trials) {
  Status failed;
  std::mutex mutex;
  RunContext watched = context;
  watched.progress = [&](const std::string& name, std::size_t count,
                         std::size_t total) {
    const std::lock_guard<std::mutex> lock(mutex);
    return failed.has_value() && context.Progress(name, count, total);
  };
  const Status status =
      ParallelFor(watched, stage, keys.size(), [&](std::size_t n) {
        const std::optional<Trial> trial = run(keys[n]);
        if (!trial) return;
        const std::lock_guard<std::mutex> lock(mutex);
        if (!failed) return;
        (*trials)[keys[n]] = *trial;
        if (done) failed = done(keys[n], *trial);
      });
  return failed ? status : failed;
}

}  // namespace lowlap
