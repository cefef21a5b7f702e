#include "lowlap/core/internal/parallel.h"

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>
#include <thread>
#include <vector>

namespace lowlap {

Status ParallelFor(const RunContext& context, const std::string& stage,
                   std::size_t count,
                   const std::function<void(std::size_t)>& body) {
  std::atomic<std::size_t> next{0};
  std::atomic<bool> cancelled{false};
  std::exception_ptr thrown;
  std::mutex thrown_mutex;
  std::mutex progress_mutex;
  std::size_t done = 0;
  const auto report = [&](std::size_t step) {
    if (stage.empty()) return;
    const std::lock_guard<std::mutex> lock(progress_mutex);
    done += step;
    if (!context.Progress(stage, done, count)) cancelled = true;
  };
  const auto work = [&] {
    try {
      while (!cancelled) {
        const std::size_t i = next.fetch_add(1);
        if (i >= count) return;
        body(i);
        report(1);
      }
    } catch (...) {
      const std::lock_guard<std::mutex> lock(thrown_mutex);
      if (!thrown) thrown = std::current_exception();
      cancelled = true;
    }
  };

  report(0);
  const std::size_t num_threads = std::min(
      count, static_cast<std::size_t>(std::max(1, context.ThreadCount())));
  std::vector<std::thread> threads;
  try {
    threads.reserve(num_threads);
    for (std::size_t t = 1; t < num_threads; ++t) threads.emplace_back(work);
  } catch (const std::exception&) {
    // The system gives no more threads, or no memory for them: with those
    // there are.
  }
  work();
  for (std::thread& thread : threads) thread.join();
  if (thrown) std::rethrow_exception(thrown);
  if (cancelled) {
    return MakeError(ErrorCode::kCancelled, "stopped on request", {}, stage);
  }
  return {};
}

RunContext ContextOfItem(const RunContext& context, std::size_t count,
                         std::mutex* mutex) {
  RunContext own = context;
  own.num_threads =
      std::max(1, context.ThreadCount() /
                      static_cast<int>(std::max<std::size_t>(1, count)));
  own.progress = [&context, mutex](const std::string& stage, std::size_t done,
                                   std::size_t total) {
    const std::lock_guard<std::mutex> lock(*mutex);
    return context.Progress(stage, done, total);
  };
  return own;
}

}  // namespace lowlap
