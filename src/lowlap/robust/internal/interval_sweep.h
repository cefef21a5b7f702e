#pragma once

#include <vector>

namespace lowlap {

/// Sweeps a set of intervals of the real axis once and tells how many cover
/// each segment between their ends, per counter: O(m log m) for m intervals.
///
/// A counter counts intervals, or members: intervals of one member of a counter
/// may overlap and are counted once (their union). The caller gives each
/// counter the number that holds everywhere.
class IntervalSweep {
 public:
  explicit IntervalSweep(int num_counters);

  /// Forgets all intervals; every counter starts at `base`. Counters must keep
  /// their number.
  void Reset(const std::vector<int>& base);
  /// Closed intervals; empty ones (end < begin, or NaN) are ignored.
  void Add(double begin, double end, int counter);
  /// Members are numbered from 0 in each counter.
  void AddMember(double begin, double end, int counter, int member);
  int num_intervals() const { return static_cast<int>(ends_.size()) / 2; }

  /// Calls visit(begin, end, counts) for every segment of [low, high], from
  /// low to high, in which the counts do not change; segments without length
  /// are passed over. counts is a std::vector<int> by counter. Independent of
  /// the order in which intervals were added.
  template <class Visit>
  void Run(double low, double high, const Visit& visit) {
    Sort();
    double at = low;
    for (const End& end : ends_) {
      if (end.at > at) {
        visit(at, end.at < high ? end.at : high, counts_);
        at = end.at;
      }
      if (at >= high) return;
      Cross(end);
    }
    if (at < high) visit(at, high, counts_);
  }

 private:
  struct End {
    double at = 0;
    int counter = 0;
    int member = 0;  // kNobody: the interval counts by itself
    int change = 0;  // +1 where it begins, -1 where it ends
  };
  static constexpr int kNobody = -1;

  void Sort();
  void Cross(const End& end);

  std::vector<End> ends_;
  std::vector<int> counts_;
  std::vector<std::vector<int>> covering_;  // intervals by counter and member
};

}  // namespace lowlap
