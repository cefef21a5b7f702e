#include "lowlap/scale/internal/criterion/ratio_density.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

namespace lowlap {
namespace {

TEST(RatioDensity, WithoutRatiosIsTheMeanEverywhere) {
  EXPECT_EQ(RatioDensity().Log10Relative(3), 0);
  EXPECT_EQ(RatioDensity(std::vector<double>()).LeastLog10Relative(-1, 1), 0);
}

// The square of a logistic density of scale s has the integral 1 / (6 s), its
// peak is 1 / (4 s).
TEST(RatioDensity, OfOneRatioIsALogistic) {
  const RatioDensity density({0.7});
  for (const double offset : {0.0, 0.2, -0.2, 0.4}) {
    const double half = 0.5 * offset / RatioDensity::kSpread;
    const double relative = 1.5 / (std::cosh(half) * std::cosh(half));
    EXPECT_NEAR(density.Log10Relative(0.7 + offset), std::log10(relative), 0.02)
        << offset;
  }
}

TEST(RatioDensity, IsHalfTheMeanAtLeast) {
  const RatioDensity density({0.0});
  for (const double far : {-20.0, -3.0, 3.0, 20.0}) {
    EXPECT_NEAR(density.Log10Relative(far), std::log10(0.5), 1e-12) << far;
  }
}

TEST(RatioDensity, OfEvenRatiosIsEven) {
  std::vector<double> sorted;
  for (int n = 0; n <= 4000; ++n) sorted.push_back(-4 + 0.002 * n);
  const RatioDensity density(sorted);
  for (double at = -2.5; at <= 2.5; at += 0.1) {
    EXPECT_NEAR(density.Log10Relative(at), 0, 0.03) << at;
  }
}

TEST(RatioDensity, MovesAndTurnsWithItsRatios) {
  const std::vector<double> sorted = {-1.0, -0.9, 0.1, 0.15, 0.2, 2.02};
  std::vector<double> moved, turned;
  for (const double log_ratio : sorted) {
    moved.push_back(log_ratio + 0.377);
    turned.insert(turned.begin(), -log_ratio);
  }
  const RatioDensity density(sorted);
  for (double at = -2; at < 3; at += 0.13) {
    const double expected = density.Log10Relative(at);
    EXPECT_NEAR(RatioDensity(moved).Log10Relative(at + 0.377), expected, 0.02);
    EXPECT_NEAR(RatioDensity(turned).Log10Relative(-at), expected, 1e-9);
  }
}

TEST(RatioDensity, TheLeastOfAnIntervalIsThatOfAScan) {
  const RatioDensity density({-1.0, -0.9, 0.1, 0.15, 0.2, 2.0});
  for (double low = -3; low < 3; low += 0.37) {
    for (const double width : {0.01, 0.5, 3.0}) {
      double scanned = density.Log10Relative(low);
      for (int n = 1; n <= 1000; ++n) {
        scanned =
            std::min(scanned, density.Log10Relative(low + 0.001 * n * width));
      }
      const double least = density.LeastLog10Relative(low, low + width);
      EXPECT_LE(least, scanned + 1e-9);
      EXPECT_GE(least, scanned - 0.01);
    }
  }
}

}  // namespace
}  // namespace lowlap
