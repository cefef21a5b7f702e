#include "lowlap/robust/internal/interval_sweep.h"

#include <algorithm>
#include <tuple>

namespace lowlap {

IntervalSweep::IntervalSweep(int num_counters)
    : counts_(num_counters, 0), covering_(num_counters) {}

void IntervalSweep::Reset(const std::vector<int>& base) {
  for (const End& end : ends_) {
    if (end.member != kNobody) covering_[end.counter][end.member] = 0;
  }
  ends_.clear();
  counts_ = base;
}

void IntervalSweep::Add(double begin, double end, int counter) {
  AddMember(begin, end, counter, kNobody);
}

void IntervalSweep::AddMember(double begin, double end, int counter,
                              int member) {
  if (!(begin <= end)) return;
  ends_.push_back({begin, counter, member, 1});
  ends_.push_back({end, counter, member, -1});
  if (member == kNobody) return;
  std::vector<int>& covering = covering_[counter];
  if (covering.size() <= static_cast<std::size_t>(member)) {
    covering.resize(member + 1, 0);
  }
}

void IntervalSweep::Sort() {
  std::sort(ends_.begin(), ends_.end(), [](const End& a, const End& b) {
    return std::tie(a.at, b.change) < std::tie(b.at, a.change);
  });
}

void IntervalSweep::Cross(const End& end) {
  if (end.member == kNobody) {
    counts_[end.counter] += end.change;
    return;
  }
  int& covering = covering_[end.counter][end.member];
  const bool was_covered = covering > 0;
  covering += end.change;
  counts_[end.counter] += (covering > 0) - was_covered;
}

}  // namespace lowlap
