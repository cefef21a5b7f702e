#include "lowlap/robust/internal/chi_square.h"

#include <gtest/gtest.h>

#include <cmath>

namespace lowlap {
namespace {

// From tables of the distribution: upper 5 %, 1 % and 0.1 % points.
TEST(LogChiSquareTailTest, TabulatedPoints) {
  const double points[][4] = {{1, 3.841459, 6.634897, 10.827566},
                              {2, 5.991465, 9.210340, 13.815511},
                              {3, 7.814728, 11.344867, 16.266236},
                              {4, 9.487729, 13.276704, 18.466827},
                              {5, 11.070498, 15.086272, 20.515006}};
  for (const auto& row : points) {
    const int dimension = static_cast<int>(row[0]);
    EXPECT_NEAR(LogChiSquareTail(row[1], dimension), std::log(0.05), 1e-6);
    EXPECT_NEAR(LogChiSquareTail(row[2], dimension), std::log(0.01), 1e-6);
    EXPECT_NEAR(LogChiSquareTail(row[3], dimension), std::log(0.001), 1e-6);
  }
}

TEST(LogChiSquareTailTest, IsZeroAtZeroAndFallsFarBelowTheLeastDouble) {
  for (int dimension = 1; dimension <= 9; ++dimension) {
    EXPECT_NEAR(LogChiSquareTail(0, dimension), 0, 1e-15);
    double last = 0;
    for (double value = 1; value < 1e6; value *= 1.7) {
      const double tail = LogChiSquareTail(value, dimension);
      EXPECT_LT(tail, last);
      EXPECT_TRUE(std::isfinite(tail));
      last = tail;
    }
  }
}

}  // namespace
}  // namespace lowlap
