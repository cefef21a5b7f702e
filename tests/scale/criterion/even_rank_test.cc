#include "lowlap/scale/internal/criterion/even_rank.h"

#include <gtest/gtest.h>

#include <cstddef>

namespace lowlap {
namespace {

TEST(EvenRank, RanksAreEvenlySpaced) {
  for (const std::size_t count : {1, 2, 7, 64, 128, 1000}) {
    for (const std::size_t num : {1, 16, 64, 255}) {
      for (std::size_t m = 0; m < num; ++m) {
        const double middle = (m + 0.5) * count / num;
        EXPECT_NEAR(EvenRank(m, num, count) + 0.5, middle, 0.5 + 1e-9);
      }
    }
  }
  for (std::size_t m = 0; m < 9; ++m) EXPECT_EQ(EvenRank(m, 9, 9), m);
}

// Also where the quotient is a whole number, as of powers of two.
TEST(EvenRank, AreTheSameReadFromTheOtherEnd) {
  for (std::size_t count = 1; count <= 600; ++count) {
    for (const std::size_t num : {1, 2, 16, 24, 64, 128, 255, 256}) {
      for (std::size_t m = 0; m < num; ++m) {
        if (2 * m + 1 == num && count % 2 == 0) continue;
        EXPECT_EQ(EvenRank(num - 1 - m, num, count),
                  count - 1 - EvenRank(m, num, count))
            << m << " of " << num << " among " << count;
      }
    }
  }
}

}  // namespace
}  // namespace lowlap
