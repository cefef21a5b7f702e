#include "lowlap/robust/internal/cauchy_scale.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lowlap {
namespace {

TEST(TruncatedCauchyScale, FindsTheScaleOfTheDensity) {
  for (const double scale : {0.1, 0.7, 2.0}) {
    for (const double reach : {1.0, 4.0, 1e6}) {
      const double median = scale * std::tan(0.5 * std::atan(reach / scale));
      EXPECT_NEAR(TruncatedCauchyScale(median, reach), scale, 1e-9 * reach);
    }
  }
}

TEST(TruncatedCauchyScale, IsInfiniteForAConstantDensity) {
  EXPECT_TRUE(std::isinf(TruncatedCauchyScale(2, 4)));
  EXPECT_TRUE(std::isinf(TruncatedCauchyScale(2.5, 4)));
  EXPECT_EQ(TruncatedCauchyScale(0, 4), 0);
}

}  // namespace
}  // namespace lowlap
