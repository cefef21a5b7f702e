#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <string>
#include <utility>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"
#include "lowlap/study/internal/trust/trial.h"

namespace lowlap {

using TrustKey = std::pair<TrustFamily, std::uint64_t>;  // and seed

struct TrustStudy {
  int num_scenes = 1000;  // of every family
  std::map<TrustKey, TrustTrial> trials;
};

/// Fills the trials that are missing: of every family the seeds context.seed,
/// context.seed + 1, ... Trials are shared out over the context's threads, each
/// on one of them; the result is the same for any number. `done` is told each
/// when it is there, from one thread at a time, in no fixed order. Errors:
/// those of `done`, kInvalidArgument for a number of scenes below 1,
/// kCancelled; then study->trials holds what was done.
Status RunTrustStudy(
    const RunContext& context,
    const std::function<Status(const TrustKey&, const TrustTrial&)>& done,
    TrustStudy* study);

}  // namespace lowlap
