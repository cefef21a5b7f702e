#pragma once

#include <cstddef>

#include "lowlap/core/result.h"
#include "lowlap/core/run_context.h"

namespace lowlap {

/// Tells the host how far an iteration has come; kCancelled if it asks to stop.
/// Every loop asks before each factorisation, or oftener.
inline Status AskToGoOn(const RunContext& context, std::size_t done,
                        std::size_t total) {
  if (context.Progress("averaging", done, total)) return {};
  return MakeError(ErrorCode::kCancelled, "stopped on request", {},
                   "averaging");
}

}  // namespace lowlap
