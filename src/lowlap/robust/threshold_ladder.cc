#include "lowlap/robust/threshold_ladder.h"

namespace lowlap {

LadderCounts CountOnLadder(const float* errors_px, int count) {
  // Two histograms, so that neighbours that fall into one bin do not wait for
  // each other.
  int even[kNumThresholds + 1] = {};
  int odd[kNumThresholds + 1] = {};
  int i = 0;
  for (; i + 1 < count; i += 2) {
    ++even[LadderStep(errors_px[i])];
    ++odd[LadderStep(errors_px[i + 1])];
  }
  if (i < count) ++even[LadderStep(errors_px[i])];
  LadderCounts counts{};
  int sum = 0;
  for (int step = 0; step < kNumThresholds; ++step) {
    sum += even[step] + odd[step];
    counts[step] = sum;
  }
  return counts;
}

}  // namespace lowlap
