#pragma once

#include <tl/expected.hpp>
#include <utility>

#include "lowlap/core/result.h"

/// Hands errors on to the caller. For sources only: a macro has no namespace,
/// so no header may use these.

#define LOWLAP_PROPAGATE_JOIN_2(a, b) a##b
#define LOWLAP_PROPAGATE_JOIN(a, b) LOWLAP_PROPAGATE_JOIN_2(a, b)
#define LOWLAP_PROPAGATE_NAME LOWLAP_PROPAGATE_JOIN(lowlap_result_, __LINE__)

/// Evaluates a Result or a Status once and returns its error, if it has one,
/// from the function around, which may return any Result.
#define LOWLAP_RETURN_IF_ERROR(...)                                            \
  do {                                                                         \
    const auto& LOWLAP_PROPAGATE_NAME = __VA_ARGS__;                           \
    if (!LOWLAP_PROPAGATE_NAME)                                                \
      return ::tl::unexpected<::lowlap::Error>(LOWLAP_PROPAGATE_NAME.error()); \
  } while (false)

/// Evaluates a Result once; returns its error, if it has one, and otherwise
/// moves its value to `target`, which may be a declaration without a comma:
///
///   LOWLAP_ASSIGN_OR_RETURN(const std::string text, ReadWholeFile(path));
///
/// It is more than one statement: a branch or a loop needs its braces.
#define LOWLAP_ASSIGN_OR_RETURN(target, ...)       \
  auto LOWLAP_PROPAGATE_NAME = __VA_ARGS__;        \
  if (!LOWLAP_PROPAGATE_NAME)                      \
    return ::tl::unexpected<::lowlap::Error>(      \
        std::move(LOWLAP_PROPAGATE_NAME).error()); \
  target = *std::move(LOWLAP_PROPAGATE_NAME)
