#include "lowlap/core/internal/random.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace lowlap {
namespace {

// The published first outputs of SplitMix64 for the seed 1234567.
TEST(Random, IsSplitMix64) {
  Random random(1234567);
  EXPECT_EQ(random.NextBits(), 6457827717110365317u);
  EXPECT_EQ(random.NextBits(), 3203168211198807973u);
  EXPECT_EQ(random.NextBits(), 9817491932198370423u);
  EXPECT_EQ(random.NextBits(), 4593380528125082431u);
  EXPECT_EQ(random.NextBits(), 16408922859458223821u);
}

TEST(Random, SameSeedSameDraws) {
  Random a(5), b(5), c(6);
  bool differs = false;
  for (int n = 0; n < 100; ++n) {
    const double x = a.Gaussian();
    EXPECT_EQ(x, b.Gaussian());
    differs = differs || x != c.Gaussian();
  }
  EXPECT_TRUE(differs);
}

TEST(Random, StreamsOfItemsDiffer) {
  std::set<std::uint64_t> first;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    for (std::uint64_t index = 0; index < 200; ++index) {
      first.insert(Random(seed, index).NextBits());
    }
  }
  EXPECT_EQ(first.size(), 20u * 200u);
}

TEST(Random, UniformCoversItsRange) {
  Random random(1);
  double sum = 0, least = 1, largest = 0;
  constexpr int kDraws = 100000;
  for (int n = 0; n < kDraws; ++n) {
    const double x = random.Uniform();
    ASSERT_GE(x, 0);
    ASSERT_LT(x, 1);
    sum += x;
    least = std::min(least, x);
    largest = std::max(largest, x);
  }
  EXPECT_NEAR(sum / kDraws, 0.5, 0.005);  // 5 sigma
  EXPECT_LT(least, 1e-3);
  EXPECT_GT(largest, 1 - 1e-3);
  for (int n = 0; n < 1000; ++n) {
    const double x = random.Uniform(-3, 5);
    ASSERT_GE(x, -3);
    ASSERT_LT(x, 5);
  }
}

TEST(Random, IndexIsUniform) {
  Random random(2);
  std::vector<int> counts(7);
  constexpr int kDraws = 70000;
  for (int n = 0; n < kDraws; ++n) ++counts.at(random.Index(7));
  for (const int count : counts) EXPECT_NEAR(count, 10000, 500);
  EXPECT_EQ(random.Index(1), 0u);
}

TEST(Random, GaussianHasItsMoments) {
  Random random(3);
  double sum = 0, squares = 0;
  int beyond_two = 0;
  constexpr int kDraws = 100000;
  for (int n = 0; n < kDraws; ++n) {
    const double x = random.Gaussian(2);
    ASSERT_TRUE(std::isfinite(x));
    sum += x;
    squares += x * x;
    beyond_two += std::abs(x) > 4;
  }
  EXPECT_NEAR(sum / kDraws, 0, 0.04);
  EXPECT_NEAR(std::sqrt(squares / kDraws), 2, 0.03);
  EXPECT_NEAR(beyond_two / static_cast<double>(kDraws), 0.0455, 0.004);
}

}  // namespace
}  // namespace lowlap
