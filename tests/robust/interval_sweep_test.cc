#include "lowlap/robust/internal/interval_sweep.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

struct Segment {
  double begin, end;
  std::vector<int> counts;
};

std::vector<Segment> Swept(IntervalSweep* sweep, double low, double high) {
  std::vector<Segment> segments;
  sweep->Run(low, high,
             [&](double begin, double end, const std::vector<int>& counts) {
               segments.push_back({begin, end, counts});
             });
  return segments;
}

TEST(IntervalSweep, CountsByBruteForceOnRandomIntervals) {
  struct Interval {
    double begin, end;
    int counter, member;
  };
  for (std::uint64_t seed = 0; seed < 200; ++seed) {
    Random random(seed);
    constexpr int kCounters = 3;
    IntervalSweep sweep(kCounters);
    const std::vector<int> base = {4, 0, 7};
    sweep.Reset(base);
    std::vector<Interval> intervals;
    const int num = static_cast<int>(random.Index(30));
    for (int n = 0; n < num; ++n) {
      // Some ends fall together.
      const double begin = std::floor(random.Uniform(0, 20));
      const double end = begin + std::floor(random.Uniform(0, 8));
      const int counter = static_cast<int>(random.Index(kCounters));
      const int member = counter == 0 ? -1 : static_cast<int>(random.Index(4));
      intervals.push_back({begin, end, counter, member});
      if (member < 0) {
        sweep.Add(begin, end, counter);
      } else {
        sweep.AddMember(begin, end, counter, member);
      }
    }
    EXPECT_EQ(sweep.num_intervals(), num);
    const std::vector<Segment> segments = Swept(&sweep, 2, 22);
    double at = 2;
    for (const Segment& segment : segments) {
      EXPECT_EQ(segment.begin, at);
      EXPECT_GT(segment.end, at);
      at = segment.end;
      const double middle = 0.5 * (segment.begin + segment.end);
      std::vector<int> expected = base;
      std::vector<std::vector<bool>> is_covered(kCounters,
                                                std::vector<bool>(4, false));
      for (const Interval& interval : intervals) {
        if (middle < interval.begin || middle > interval.end) continue;
        if (interval.member < 0) {
          ++expected[interval.counter];
        } else if (!is_covered[interval.counter][interval.member]) {
          is_covered[interval.counter][interval.member] = true;
          ++expected[interval.counter];
        }
      }
      EXPECT_EQ(segment.counts, expected);
    }
    EXPECT_EQ(at, 22);
  }
}

TEST(IntervalSweep, CountsOverlappingIntervalsOfAMemberOnce) {
  IntervalSweep sweep(1);
  sweep.Reset({0});
  sweep.AddMember(0, 2, 0, 5);
  sweep.AddMember(1, 3, 0, 5);
  sweep.AddMember(2.5, 4, 0, 1);
  const std::vector<Segment> segments = Swept(&sweep, 0, 5);
  ASSERT_EQ(segments.size(), 6u);
  const std::vector<int> expected = {1, 1, 1, 2, 1, 0};
  for (std::size_t n = 0; n < segments.size(); ++n) {
    EXPECT_EQ(segments[n].counts[0], expected[n]) << n;
  }
}

TEST(IntervalSweep, ForgetsWhatItHadWhenItIsReset) {
  IntervalSweep sweep(1);
  sweep.Reset({0});
  // Stopped in the middle of the member's interval.
  sweep.AddMember(0, 10, 0, 0);
  Swept(&sweep, 0, 5);
  sweep.Reset({2});
  sweep.AddMember(1, 2, 0, 0);
  const std::vector<Segment> segments = Swept(&sweep, 0, 3);
  ASSERT_EQ(segments.size(), 3u);
  EXPECT_EQ(segments[0].counts[0], 2);
  EXPECT_EQ(segments[1].counts[0], 3);
  EXPECT_EQ(segments[2].counts[0], 2);
}

TEST(IntervalSweep, IgnoresEmptyIntervals) {
  IntervalSweep sweep(1);
  sweep.Reset({0});
  sweep.Add(2, 1, 0);
  sweep.Add(std::numeric_limits<double>::quiet_NaN(), 1, 0);
  EXPECT_EQ(sweep.num_intervals(), 0);
  const std::vector<Segment> segments = Swept(&sweep, 0, 3);
  ASSERT_EQ(segments.size(), 1u);
  EXPECT_EQ(segments[0].counts[0], 0);
}

}  // namespace
}  // namespace lowlap
