#include "lowlap/two_view/internal/kernels/polynomial.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

std::vector<double> FromRoots(const std::vector<double>& roots) {
  std::vector<double> c = {1};
  for (const double root : roots) {
    c.insert(c.begin(), 0);
    for (std::size_t i = 0; i + 1 < c.size(); ++i) c[i] -= root * c[i + 1];
  }
  return c;
}

TEST(RealRootsInInterval, FindsTheRootsInsideOnly) {
  const auto roots = RealRootsInInterval(FromRoots({-2, -0.5, 0.25, 3}), -1, 1);
  ASSERT_EQ(roots.size(), 2u);
  EXPECT_NEAR(roots[0], -0.5, 1e-14);
  EXPECT_NEAR(roots[1], 0.25, 1e-14);
}

TEST(RealRootsInInterval, FindsAllOfTenRandomRoots) {
  Random random(1);
  for (int trial = 0; trial < 200; ++trial) {
    std::vector<double> expected;
    for (int i = 0; i < 10; ++i) {
      expected.push_back(-0.95 + 0.2 * i + random.Uniform(-0.05, 0.05));
    }
    const auto roots = RealRootsInInterval(FromRoots(expected), -1, 1);
    ASSERT_EQ(roots.size(), 10u);
    for (int i = 0; i < 10; ++i) EXPECT_NEAR(roots[i], expected[i], 1e-8);
  }
}

TEST(RealRootsInInterval, ReportsADoubleRoot) {
  const auto roots = RealRootsInInterval(FromRoots({0.3, 0.3, 0.8}), -1, 1);
  ASSERT_GE(roots.size(), 2u);
  EXPECT_NEAR(roots.front(), 0.3, 1e-7);
  EXPECT_NEAR(roots.back(), 0.8, 1e-12);
}

TEST(RealRootsInInterval, HandlesEndsZerosAndConstants) {
  EXPECT_EQ(RealRootsInInterval({0, 1}, 0, 1), std::vector<double>({0}));
  EXPECT_EQ(RealRootsInInterval({-1, 1}, 0, 1), std::vector<double>({1}));
  EXPECT_TRUE(RealRootsInInterval({2}, -1, 1).empty());
  EXPECT_TRUE(RealRootsInInterval({0, 0, 0}, -1, 1).empty());
  EXPECT_TRUE(RealRootsInInterval({1, 0, 1}, -1, 1).empty());
  const auto linear = RealRootsInInterval({-0.5, 1, 0, 0}, -1, 1);
  ASSERT_EQ(linear.size(), 1u) << "leading zeros";
}

}  // namespace
}  // namespace lowlap
