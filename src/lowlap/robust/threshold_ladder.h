#pragma once

#include <array>
#include <cstdint>
#include <cstring>

namespace lowlap {

/// A fixed ladder of inlier thresholds, two per octave:
///   0.125, 0.1875, 0.25, 0.375, 0.5, ..., 12, 16 pixels.
/// Counting features per step replaces sorting their errors, and makes the
/// number of thresholds that a criterion tries a small known number.
inline constexpr int kNumThresholds = 15;

/// Threshold of a step in pixels; the features of the step have smaller errors.
constexpr double LadderThresholdPx(int step) {
  double threshold_px = 0.125;
  for (int s = 2; s <= step; s += 2) threshold_px *= 2.0;
  return (step % 2 == 1) ? 1.5 * threshold_px : threshold_px;
}

/// The lowest step whose threshold is above the error; kNumThresholds if none
/// is, and for NaN.
inline int LadderStep(float error_px) {
  // The exponent and the first bit of the mantissa number the half octaves.
  std::uint32_t bits = 0;
  std::memcpy(&bits, &error_px, sizeof bits);
  constexpr int kHalfOctaveOfFirst = 2 * (127 - 3);  // of 0.125
  const int step = static_cast<int>(bits >> 22) - kHalfOctaveOfFirst + 1;
  return step < 0 ? 0 : (step > kNumThresholds ? kNumThresholds : step);
}

/// Per step, how many features are inliers.
using LadderCounts = std::array<int, kNumThresholds>;
/// Per step, the probability that an unrelated feature is an inlier.
using LadderProbabilities = std::array<double, kNumThresholds>;

/// Counts the non-negative errors below each threshold.
LadderCounts CountOnLadder(const float* errors_px, int count);

}  // namespace lowlap
