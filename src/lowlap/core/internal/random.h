#pragma once

#include <cstdint>

#include "lowlap/core/ids.h"

namespace lowlap {

/// A small seeded generator (SplitMix64, Steele et al. 2014) with draws that
/// are the same on every platform, unlike those of the standard library.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  /// A stream of its own for item `index` of a run seeded with `seed`.
  Random(std::uint64_t seed, std::uint64_t index);

  std::uint64_t NextBits();
  /// Uniform in [0, 1).
  double Uniform();
  /// Uniform in [low, high).
  double Uniform(double low, double high);
  /// Uniform in {0, ..., count - 1}; count > 0.
  std::uint32_t Index(std::uint32_t count);
  /// Normal with mean 0 and the given standard deviation.
  double Gaussian(double stddev = 1.0);

 private:
  std::uint64_t state_;
};

/// Seed of what is drawn for a pair, whatever else is in the run.
std::uint64_t PairSeed(std::uint64_t seed, const ViewPair& pair);

}  // namespace lowlap
