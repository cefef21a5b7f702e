#pragma once

#include <ctime>

namespace lowlap::testing {

/// Processor time of `work()` in seconds, which a busy machine hardly changes.
template <class Work>
double ProcessorSeconds(const Work& work) {
  const std::clock_t start = std::clock();
  work();
  return static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC;
}

}  // namespace lowlap::testing
