#include "lowlap/core/internal/random.h"

#include <cmath>

namespace lowlap {
namespace {

constexpr std::uint64_t kGolden = 0x9E3779B97F4A7C15ull;

std::uint64_t Mix(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
  return z ^ (z >> 31);
}

}  // namespace

Random::Random(std::uint64_t seed, std::uint64_t index)
    : state_(Mix(seed + kGolden) ^ Mix(index * kGolden + 1)) {}

std::uint64_t Random::NextBits() { return Mix(state_ += kGolden); }

double Random::Uniform() {
  return static_cast<double>(NextBits() >> 11) * 0x1.0p-53;
}

double Random::Uniform(double low, double high) {
  return low + (high - low) * Uniform();
}

std::uint32_t Random::Index(std::uint32_t count) {
  return static_cast<std::uint32_t>(
      ((NextBits() >> 32) * static_cast<std::uint64_t>(count)) >> 32);
}

double Random::Gaussian(double stddev) {
  constexpr double kTwoPi = 6.283185307179586;
  const double u = 1.0 - Uniform();  // in (0, 1]
  return stddev * std::sqrt(-2.0 * std::log(u)) * std::cos(kTwoPi * Uniform());
}

std::uint64_t PairSeed(std::uint64_t seed, const ViewPair& pair) {
  return seed * kGolden +
         (static_cast<std::uint64_t>(pair.first.value()) << 32) +
         pair.second.value();
}

}  // namespace lowlap
