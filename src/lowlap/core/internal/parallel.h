#pragma once

#include <cstddef>
#include <functional>
#include <mutex>
#include <string>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// Calls body(i) once for every i in [0, count), on the context's threads.
///
/// Items are handed out one at a time, so uneven work balances. Determinism is
/// the caller's: write results to slot i and draw random numbers from a
/// generator seeded by i, never from a shared one. `stage` names the progress
/// messages (empty: none). kCancelled if the progress sink stopped it: items
/// are then left undone. What `body` throws stops it, too, and is rethrown.
Status ParallelFor(const RunContext& context, const std::string& stage,
                   std::size_t count,
                   const std::function<void(std::size_t)>& body);

/// For what bodies of a ParallelFor over `count` items call: reports progress
/// from one thread at a time, and has an item's share of the threads. Context
/// and mutex must outlive it.
RunContext ContextOfItem(const RunContext& context, std::size_t count,
                         std::mutex* mutex);

}  // namespace lowlap
