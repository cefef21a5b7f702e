#include "lowlap/scale/internal/search/ratio_sweep.h"

#include <algorithm>
#include <cmath>
#include <queue>
#include <vector>

#include "lowlap/robust/interval_sweep.h"
#include "lowlap/scale/internal/search/feature_intervals.h"
#include "lowlap/scale/internal/search/second_mode.h"

namespace lowlap {
namespace {

// Counters of the sweep: a ladder each for points, lines, plane points, and
// both sides of every tier of pairs.
constexpr int kPoints = 0;
constexpr int kLines = kNumThresholds;
constexpr int kPlanePoints = 2 * kNumThresholds;
constexpr int Side(int tier, int side) {
  return (3 + 2 * tier + side) * kNumThresholds;
}
constexpr int kNumCounters = Side(kPairTiers, 0);

void ToCounters(const SupportCounts& counts, std::vector<int>* counters) {
  counters->resize(kNumCounters);
  const auto copy = [&](const LadderCounts& ladder, int at) {
    std::copy(ladder.begin(), ladder.end(), counters->begin() + at);
  };
  copy(counts.points, kPoints);
  copy(counts.lines, kLines);
  copy(counts.plane_points, kPlanePoints);
  for (int t = 0; t < kPairTiers; ++t) {
    copy(counts.coplanar[t].first, Side(t, 0));
    copy(counts.coplanar[t].last, Side(t, 1));
  }
}

void FromCounters(const std::vector<int>& counters, SupportCounts* counts) {
  const auto copy = [&](int at, LadderCounts* ladder) {
    std::copy_n(counters.begin() + at, kNumThresholds, ladder->begin());
  };
  copy(kPoints, &counts->points);
  copy(kLines, &counts->lines);
  copy(kPlanePoints, &counts->plane_points);
  for (int t = 0; t < kPairTiers; ++t) {
    copy(Side(t, 0), &counts->coplanar[t].first);
    copy(Side(t, 1), &counts->coplanar[t].last);
  }
}

struct Window {
  double low = 0;
  double high = 0;
  RatioNfaBound bounds;

  // For a queue that hands out the least bound first.
  bool operator<(const Window& other) const {
    return bounds.log10_nfa != other.bounds.log10_nfa
               ? bounds.log10_nfa > other.bounds.log10_nfa
               : low > other.low;
  }
};

class RatioSweeper {
 public:
  RatioSweeper(const RatioSupport& support, const RatioNfaCriterion& criterion)
      : support_(support), criterion_(criterion), sweep_(kNumCounters) {}

  RatioOptimum Run(double low, double high) {
    for (const double seed : Seeds(low, high)) Try(seed);
    PushAround(best_.log_ratio, low, high);
    const int few =
        std::max<int>(32, static_cast<int>(support_.hypotheses().size()) / 20);
    while (!windows_.empty()) {
      const Window window = windows_.top();
      windows_.pop();
      if (!CanBeat(window.bounds.log10_nfa)) break;
      FindUsefulSteps(window.bounds);
      constexpr double kNarrow = 1e-7;
      if (NumCrossings(window) <= few || window.high - window.low < kNarrow) {
        Sweep(window);
        continue;
      }
      const double middle = 0.5 * (window.low + window.high);
      Try(middle);
      Push(window.low, middle);
      Push(middle, window.high);
    }
    TryNeighbors(low, high);
    return best_;
  }

 private:
  static constexpr double kTolerance = 1e-9;

  bool CanBeat(double log10_nfa) const {
    return log10_nfa < best_.nfa.log10_nfa - kTolerance;
  }

  // The steps of the ladder that can decide in a window for a better ratio than
  // the best one. The others need no ends of intervals.
  void FindUsefulSteps(const RatioNfaBound& bounds) {
    const auto find = [&](const LadderValues& values, int first_counter) {
      for (int step = 0; step < kNumThresholds; ++step) {
        is_useful_[first_counter + step] = CanBeat(values[step]);
      }
    };
    find(bounds.points, kPoints);
    find(bounds.lines, kLines);
    find(bounds.plane_points, kPlanePoints);
    for (int t = 0; t < kPairTiers; ++t) {
      find(bounds.coplanar[t], Side(t, 0));
      find(bounds.coplanar[t], Side(t, 1));
    }
  }

  // Whether the step says something for the features of a kind.
  bool IsUseful(FeatureKind kind, int step) const {
    if (kind == FeatureKind::kPoint) return is_useful_[kPoints + step];
    if (kind == FeatureKind::kLine) return is_useful_[kLines + step];
    if (kind == FeatureKind::kPlanePoint) {
      return is_useful_[kPlanePoints + step];
    }
    bool is_useful = false;
    for (int t = 0; t < kPairTiers; ++t) {
      is_useful = is_useful || is_useful_[Side(t, 0) + step];
    }
    return is_useful;
  }

  // Where the ratios of each kind, and all of them, lie closest.
  std::vector<double> Seeds(double low, double high) const {
    std::array<std::vector<double>, kFeatureKinds.size() + 1> ratios;
    for (const Hypothesis& hypothesis : support_.hypotheses()) {
      if (hypothesis.log_ratio < low || hypothesis.log_ratio > high) continue;
      ratios[static_cast<std::size_t>(hypothesis.kind)].push_back(
          hypothesis.log_ratio);
      ratios.back().push_back(hypothesis.log_ratio);
    }
    std::vector<double> seeds;
    for (const std::vector<double>& sorted : ratios) {
      if (sorted.empty()) continue;
      seeds.push_back(HalfSampleMode(sorted));
      seeds.push_back(sorted[sorted.size() / 2]);
      // All of one kind: the same again.
      if (sorted.size() == ratios.back().size()) break;
    }
    if (seeds.empty()) seeds.push_back(0.5 * (low + high));
    return seeds;
  }

  void Try(double log_ratio) {
    const RatioNfa nfa = criterion_.EvaluateAt(
        log_ratio, support_.Count(log_ratio, &workspace_));
    if (!has_best_ || nfa.BetterThan(best_.nfa)) best_ = {log_ratio, nfa};
    has_best_ = true;
  }

  // The ratios of features beside the best one: within its segment they differ
  // by the densities alone, which rounding may bring beyond the ends tried.
  void TryNeighbors(double low, double high) {
    constexpr std::ptrdiff_t kNeighbors = 4;
    const std::vector<Hypothesis>& all = support_.hypotheses();
    const auto at =
        std::lower_bound(all.begin(), all.end(), best_.log_ratio,
                         [](const Hypothesis& hypothesis, double log_ratio) {
                           return hypothesis.log_ratio < log_ratio;
                         });
    const auto begin = at - std::min(kNeighbors, at - all.begin());
    const auto end = at + std::min(kNeighbors, all.end() - at);
    for (auto it = begin; it != end; ++it) {
      if (it->log_ratio >= low && it->log_ratio <= high) Try(it->log_ratio);
    }
  }

  void Push(double low, double high) {
    if (!(low < high)) return;
    support_.Bound(low, high, &least_px_, nullptr);
    const RatioNfaBound bounds =
        criterion_.Bound(low, high, support_.Count(least_px_, &workspace_));
    if (CanBeat(bounds.log10_nfa)) windows_.push({low, high, bounds});
  }

  // Windows that grow with their distance from the best ratio so far.
  void PushAround(double center, double low, double high) {
    constexpr double kFirst = 1e-3;
    constexpr double kGrowth = 8;
    for (const int side : {-1, 1}) {
      const double last = side < 0 ? center - low : high - center;
      double near = 0;
      for (double far = kFirst; near < last; far *= kGrowth) {
        far = std::min(far, last);
        Push(side < 0 ? center - far : center + near,
             side < 0 ? center - near : center + far);
        near = far;
      }
    }
  }

  // Fills the bounds of the window and counts the thresholds that errors may
  // cross in it.
  int NumCrossings(const Window& window) {
    support_.Bound(window.low, window.high, &least_px_, &most_px_);
    int crossings = 0;
    for (const FeatureKind kind : kFeatureKinds) {
      const std::size_t k = static_cast<std::size_t>(kind);
      std::array<int, kNumThresholds + 1> useful_before{};
      for (int step = 0; step < kNumThresholds; ++step) {
        useful_before[step + 1] = useful_before[step] + IsUseful(kind, step);
      }
      for (std::size_t n = 0; n < least_px_[k].size(); ++n) {
        crossings += useful_before[LadderStep(most_px_[k][n])] -
                     useful_before[LadderStep(least_px_[k][n])];
      }
    }
    return crossings;
  }

  // Needs the bounds that NumCrossings leaves.
  void Sweep(const Window& window) {
    ToCounters(support_.Count(most_px_, &workspace_), &counters_);
    sweep_.Reset(counters_);
    AddFeatures(window, FeatureKind::kPoint, kPoints);
    AddFeatures(window, FeatureKind::kLine, kLines);
    AddFeatures(window, FeatureKind::kPlanePoint, kPlanePoints);
    AddPairs(window);
    SupportCounts counts;
    const auto score = [&](double log_ratio) {
      if (CanBeat(criterion_.EvaluateAt(log_ratio, counts).log10_nfa)) {
        Try(log_ratio);
      }
    };
    sweep_.Run(window.low, window.high,
               [&](double begin, double end, const std::vector<int>& counters) {
                 constexpr double kInside = 1e-3;
                 FromCounters(counters, &counts);
                 score(begin + kInside * (end - begin));
                 score(end - kInside * (end - begin));
               });
  }

  void AddFeatures(const Window& window, FeatureKind kind, int first_counter) {
    const std::size_t k = static_cast<std::size_t>(kind);
    for (std::size_t n = 0; n < least_px_[k].size(); ++n) {
      VisitInlierIntervals(
          support_, kind, static_cast<int>(n), window.low, window.high,
          LadderStep(least_px_[k][n]), LadderStep(most_px_[k][n]),
          [&](int step) { return IsUseful(kind, step); },
          [&](int step, double begin, double end) {
            sweep_.Add(begin, end, first_counter + step);
          });
    }
  }

  void AddPairs(const Window& window) {
    const std::size_t k = static_cast<std::size_t>(FeatureKind::kCoplanar);
    const std::vector<float>& most = most_px_[k];
    // From which step on a line is an inlier in the whole window.
    std::array<std::array<std::vector<int>, 2>, kPairTiers> sure;
    for (int t = 0; t < kPairTiers; ++t) {
      sure[t][0].assign(support_.Tier(t).num_first, kNumThresholds);
      sure[t][1].assign(support_.Tier(t).num_last, kNumThresholds);
      for (int pair = 0; pair < support_.Tier(t).num_pairs; ++pair) {
        for (const int side : {0, 1}) {
          int& step = sure[t][side][LineOf(pair, side)];
          step = std::min(step, LadderStep(most[pair]));
        }
      }
    }
    for (int pair = 0; pair < support_.num_pairs(); ++pair) {
      VisitInlierIntervals(
          support_, FeatureKind::kCoplanar, pair, window.low, window.high,
          LadderStep(least_px_[k][pair]), LadderStep(most[pair]),
          [&](int step) { return IsUseful(FeatureKind::kCoplanar, step); },
          [&](int step, double begin, double end) {
            for (int t = support_.TierOfPair(pair); t < kPairTiers; ++t) {
              if (!is_useful_[Side(t, 0) + step]) continue;
              for (const int side : {0, 1}) {
                const int line = LineOf(pair, side);
                if (step >= sure[t][side][line]) continue;
                sweep_.AddMember(begin, end, Side(t, side) + step, line);
              }
            }
          });
    }
  }

  int LineOf(int pair, int side) const {
    return side == 0 ? support_.FirstLineOf(pair) : support_.LastLineOf(pair);
  }

  const RatioSupport& support_;
  const RatioNfaCriterion& criterion_;
  RatioOptimum best_;
  bool has_best_ = false;
  std::priority_queue<Window> windows_;
  IntervalSweep sweep_;
  SupportWorkspace workspace_;
  KindErrors least_px_;
  KindErrors most_px_;
  std::vector<int> counters_;
  std::array<bool, kNumCounters> is_useful_{};
};

}  // namespace

RatioOptimum SweepRatios(const RatioSupport& support,
                         const RatioNfaCriterion& criterion, double low,
                         double high) {
  return RatioSweeper(support, criterion).Run(low, high);
}

RatioOptimum SweepRatios(const RatioSupport& support,
                         const RatioNfaCriterion& criterion) {
  return SweepRatios(support, criterion, support.hypotheses().front().log_ratio,
                     support.hypotheses().back().log_ratio);
}

}  // namespace lowlap
