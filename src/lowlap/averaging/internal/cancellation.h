#pragma once

#include <cstddef>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// Tells the host how far an iteration has come; kCancelled if it asks to stop.
/// Every loop asks before each factorisation, or oftener.
template <class Count, class Total>
Status AskToGoOn(const RunContext& context, Count done, Total total) {
  if (context.Progress("averaging", static_cast<std::size_t>(done),
                       static_cast<std::size_t>(total))) {
    return {};
  }
  return MakeError(ErrorCode::kCancelled, "stopped on request", {},
                   "averaging");
}

}  // namespace lowlap
