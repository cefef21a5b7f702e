#pragma once

#include "lowlap/core/result.h"

namespace lowlap {

/// Thrown while a file is taken apart, and caught at the boundary of io.
struct Failure {
  Error error;
};

}  // namespace lowlap
