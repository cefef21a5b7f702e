#pragma once

#include <ctime>

namespace lowlap::testing {

/// Processor time of this program so far.
inline double ProcessorSecondsNow() {
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
}

/// Processor time of `work()` in seconds, which a busy machine hardly changes.
template <class Work>
double ProcessorSeconds(const Work& work) {
  const double start = ProcessorSecondsNow();
  work();
  return ProcessorSecondsNow() - start;
}

}  // namespace lowlap::testing
