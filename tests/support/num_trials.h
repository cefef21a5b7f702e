#pragma once

namespace lowlap::testing {

/// Trials of a test that counts how often something happens: `num`, and under
/// sanitizers a quarter of it. Those look for faults of the code, which further
/// trials run through again, thirty times as slowly. For bounds that fewer
/// trials hold as well: at most so many may fail.
constexpr int NumTrials(int num) {
#ifdef LOWLAP_SANITIZED
  return num / 4;
#else
  return num;
#endif
}

}  // namespace lowlap::testing
