#include "lowlap/scale/internal/search/ratio_sweep.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/robust/internal/interval_sweep.h"
#include "lowlap/scale/internal/search/candidate_intervals.h"
#include "lowlap/scale/internal/search/second_mode.h"

namespace lowlap {
namespace {

struct Window {
  double low = 0;
  double high = 0;
  RatioNfaBound bounds;

  // For a heap that hands out the least bound first.
  bool operator<(const Window& other) const {
    return bounds.log10_nfa != other.bounds.log10_nfa
               ? bounds.log10_nfa > other.bounds.log10_nfa
               : low > other.low;
  }
};

class RatioSweeper {
 public:
  RatioSweeper(const RatioSupport& support, const RatioNfaCriterion& criterion)
      : support_(support),
        criterion_(criterion),
        sweep_(support.num_counters() * kNumThresholds),
        is_useful_(support.num_tiers()) {}

  RatioOptimum Run(double low, double high) {
    for (const double seed : Seeds(low, high)) Try(seed);
    PushAround(best_.log_ratio, low, high);
    const int few =
        std::max<int>(32, static_cast<int>(support_.hypotheses().size()) / 20);
    while (!windows_.empty()) {
      std::pop_heap(windows_.begin(), windows_.end());
      const Window window = std::move(windows_.back());
      windows_.pop_back();
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
    for (int t = 0; t < support_.num_tiers(); ++t) {
      for (int step = 0; step < kNumThresholds; ++step) {
        is_useful_[t][step] = CanBeat(bounds.tiers[t][step]);
      }
    }
  }

  // Whether the step says something for the candidates of a kind.
  bool IsUseful(int kind, int step) const {
    const int first = support_.FirstTier(kind);
    const int end = first + support_.kind(kind).units().num_tiers();
    for (int t = first; t < end; ++t) {
      if (is_useful_[t][step]) return true;
    }
    return false;
  }

  // Where the ratios of each kind, and all of them, lie closest.
  std::vector<double> Seeds(double low, double high) const {
    std::vector<std::vector<double>> ratios(support_.num_kinds() + 1);
    for (const Hypothesis& hypothesis : support_.hypotheses()) {
      if (hypothesis.log_ratio < low || hypothesis.log_ratio > high) continue;
      ratios[hypothesis.kind].push_back(hypothesis.log_ratio);
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
    RatioNfa nfa =
        criterion_.Evaluate(log_ratio, support_.Count(log_ratio, &workspace_));
    if (!has_best_ || nfa.BetterThan(best_.nfa)) {
      best_ = {log_ratio, std::move(nfa)};
    }
    has_best_ = true;
  }

  // The ratios of candidates beside the best one: within its segment they
  // differ by the densities alone, which rounding may bring beyond the ends
  // tried.
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
    support_.Bound(low, high, &least_, nullptr);
    RatioNfaBound bounds =
        criterion_.Bound(low, high, support_.Count(least_, &workspace_));
    if (!CanBeat(bounds.log10_nfa)) return;
    windows_.push_back({low, high, std::move(bounds)});
    std::push_heap(windows_.begin(), windows_.end());
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
    support_.Bound(window.low, window.high, &least_, &most_);
    int crossings = 0;
    for (int k = 0; k < support_.num_kinds(); ++k) {
      std::array<int, kNumThresholds + 1> useful_before{};
      for (int step = 0; step < kNumThresholds; ++step) {
        useful_before[step + 1] = useful_before[step] + IsUseful(k, step);
      }
      for (std::size_t n = 0; n < least_[k].size(); ++n) {
        crossings += useful_before[LadderStep(most_[k][n])] -
                     useful_before[LadderStep(least_[k][n])];
      }
    }
    return crossings;
  }

  // Needs the bounds that NumCrossings leaves.
  void Sweep(const Window& window) {
    counters_.clear();
    for (const LadderCounts& counts : support_.Count(most_, &workspace_)) {
      counters_.insert(counters_.end(), counts.begin(), counts.end());
    }
    sweep_.Reset(counters_);
    for (int k = 0; k < support_.num_kinds(); ++k) {
      support_.kind(k).units().num_sides == 1 ? AddCandidates(window, k)
                                              : AddPairs(window, k);
    }
    SupportCounts counts(support_.num_counters());
    const auto score = [&](double log_ratio) {
      const bool can_beat =
          CanBeat(criterion_.Evaluate(log_ratio, counts).log10_nfa);
      if (can_beat) Try(log_ratio);
      return can_beat;
    };
    sweep_.Run(window.low, window.high,
               [&](double begin, double end, const std::vector<int>& counters) {
                 constexpr double kInside = 1e-3;
                 auto from = counters.begin();
                 for (LadderCounts& ladder : counts) {
                   std::copy_n(from, kNumThresholds, ladder.begin());
                   from += kNumThresholds;
                 }
                 const bool near_begin = score(begin + kInside * (end - begin));
                 const bool near_end = score(end - kInside * (end - begin));
                 // Ends are as inexact as the errors: of a narrow segment what
                 // was tried may lie beyond them.
                 if (near_begin || near_end) score(0.5 * (begin + end));
               });
  }

  // Calls visit(step, begin, end) for the intervals of the window in which a
  // candidate is an inlier.
  template <class Visit>
  void VisitIntervals(const Window& window, int kind, int candidate,
                      const Visit& visit) const {
    VisitInlierIntervals(
        support_.kind(kind), candidate, window.low, window.high,
        LadderStep(least_[kind][candidate]), LadderStep(most_[kind][candidate]),
        [&](int step) { return IsUseful(kind, step); }, visit);
  }

  void AddCandidates(const Window& window, int kind) {
    const EvidenceUnits& units = support_.kind(kind).units();
    const int first_counter = support_.FirstCounter(kind);
    for (int n = 0; n < support_.kind(kind).size(); ++n) {
      VisitIntervals(window, kind, n, [&](int step, double begin, double end) {
        for (int t = support_.TierOf(kind, n); t < units.num_tiers(); ++t) {
          sweep_.Add(begin, end, (first_counter + t) * kNumThresholds + step);
        }
      });
    }
  }

  void AddPairs(const Window& window, int kind) {
    const EvidenceUnits& units = support_.kind(kind).units();
    // From which step on a unit is an inlier in the whole window.
    std::vector<std::array<std::vector<int>, 2>> sure(units.num_tiers());
    for (int t = 0; t < units.num_tiers(); ++t) {
      for (const int side : {0, 1}) {
        sure[t][side].assign(units.tiers[t].num_units[side], kNumThresholds);
        for (int pair = 0; pair < units.tiers[t].num_candidates; ++pair) {
          int& step = sure[t][side][units.of_pair[side][pair]];
          step = std::min(step, LadderStep(most_[kind][pair]));
        }
      }
    }
    for (int pair = 0; pair < support_.kind(kind).size(); ++pair) {
      VisitIntervals(
          window, kind, pair, [&](int step, double begin, double end) {
            for (int t = support_.TierOf(kind, pair); t < units.num_tiers();
                 ++t) {
              if (!is_useful_[support_.FirstTier(kind) + t][step]) continue;
              for (const int side : {0, 1}) {
                const int unit = units.of_pair[side][pair];
                if (step >= sure[t][side][unit]) continue;
                const int counter = support_.FirstCounter(kind) + 2 * t + side;
                sweep_.AddMember(begin, end, counter * kNumThresholds + step,
                                 unit);
              }
            }
          });
    }
  }

  const RatioSupport& support_;
  const RatioNfaCriterion& criterion_;
  RatioOptimum best_;
  bool has_best_ = false;
  std::vector<Window> windows_;  // a heap
  IntervalSweep sweep_;
  SupportWorkspace workspace_;
  KindErrors least_;
  KindErrors most_;
  std::vector<int> counters_;
  std::vector<std::array<bool, kNumThresholds>> is_useful_;  // by tier
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
