#include <gtest/gtest.h>

#include <cstdio>

#include "scale/interval_classes.h"

namespace lowlap {
namespace {

using testing::AllIntervalClasses;
using testing::IntervalClass;
using testing::IntervalCoverage;

// The table by class; each to within what chance does to its count.
TEST(RatioInterval, HoldsTheTruthInEveryClass) {
  constexpr int kRight = 400, kMost = 3000;
  std::uint64_t class_seed = 1;
  IntervalCoverage all;
  std::printf("%-40s %10s %6s %7s\n", "class", "meaningful", "right", "inside");
  for (const IntervalClass& of : AllIntervalClasses()) {
    const IntervalCoverage coverage =
        MeasureCoverage(of, kRight, kMost, class_seed++);
    std::printf("%-40s %10d %6d %6.1f%%\n", of.Name().c_str(),
                coverage.meaningful, coverage.right, 100 * coverage.Share());
    all.Add(coverage);
    ASSERT_GE(coverage.right, 300) << of.Name();
    const double chance = 2.6 * std::sqrt(0.05 * 0.95 / coverage.right);
    EXPECT_GE(coverage.Share(), 0.93 - chance) << of.Name();
    EXPECT_LE(coverage.Share(), 0.97 + chance) << of.Name();
  }
  std::printf("all: %.2f%%\n", 100 * all.Share());
  EXPECT_NEAR(all.Share(), 0.95, 0.01);
}

}  // namespace
}  // namespace lowlap
