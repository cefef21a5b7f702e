#include "lowlap/adjustment/internal/rounds/pair_selection.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "lowlap/adjustment/internal/rounds/pair_gap.h"
#include "lowlap/adjustment/internal/rounds/pair_terms.h"

namespace lowlap {
namespace {

constexpr int kMaxTimesDropped = 2;  // in and out for ever helps nobody

}  // namespace

std::size_t SelectPairs(const AdjustmentOptions& options,
                        const CameraSet& cameras, double threshold_px,
                        bool take_new, StructureState* state) {
  const std::vector<PairGap> gaps = ComputePairGaps(cameras, *state);
  std::vector<char> determined(state->lines.size(), 0);
  for (std::size_t n = 0; n < determined.size(); ++n) {
    determined[n] = state->lines[n].PoseCount(cameras) > 2 ? 1 : 0;
  }
  std::vector<int> degree(state->lines.size(), 0);
  std::vector<std::size_t> waiting;
  std::size_t changed = 0;
  for (std::size_t n = 0; n < gaps.size(); ++n) {
    PairState& pair = state->pairs[n];
    if (pair.used) {
      pair.used = std::isfinite(gaps[n].gap_px) &&
                  PairErrorPx(cameras, *state, pair,
                              options.coplanar_residual) <= threshold_px;
      pair.consistent = pair.used;
      if (pair.used) {
        ++degree[pair.first];
        ++degree[pair.second];
      } else {
        ++changed;
        ++pair.times_dropped;
      }
      continue;
    }
    pair.consistent =
        pair.times_dropped < kMaxTimesDropped && gaps[n].gap_px <= threshold_px;
    if (take_new && pair.consistent &&
        !(determined[pair.first] && determined[pair.second])) {
      waiting.push_back(n);
    }
  }
  std::stable_sort(waiting.begin(), waiting.end(),
                   [&](std::size_t a, std::size_t b) {
                     return gaps[a].unit_stddev < gaps[b].unit_stddev;
                   });
  for (const std::size_t n : waiting) {
    PairState& pair = state->pairs[n];
    if (degree[pair.first] >= options.max_pairs_per_line ||
        degree[pair.second] >= options.max_pairs_per_line) {
      continue;
    }
    ++degree[pair.first];
    ++degree[pair.second];
    pair.used = true;
    ++changed;
  }
  return changed;
}

}  // namespace lowlap
