#include "lowlap/scale/evidence/internal/least_first.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "lowlap/core/random.h"

namespace lowlap {
namespace {

using Entries = std::vector<std::pair<double, int>>;

Entries Sorted(const Eigen::ArrayXd& values) {
  Entries entries;
  for (Eigen::Index n = 0; n < values.size(); ++n) {
    entries.emplace_back(values(n), static_cast<int>(n));
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

Entries All(LeastFirst* least) {
  Entries entries;
  for (; const auto* entry = least->Front(); least->Pop()) {
    entries.push_back(*entry);
  }
  return entries;
}

TEST(LeastFirst, HandsOutAllInOrder) {
  LeastFirst least;
  Random random(3);
  for (const int size : {0, 1, 31, 64, 65, 500, 3000}) {
    Eigen::ArrayXd values(size);
    for (double& value : values) value = random.Gaussian(1.0);
    least.Reset(values);
    EXPECT_EQ(All(&least), Sorted(values)) << size;
  }
}

TEST(LeastFirst, TiesGoByIndex) {
  LeastFirst least;
  Random random(4);
  for (const int levels : {1, 2, 5}) {
    Eigen::ArrayXd values(400);
    for (double& value : values) value = std::floor(levels * random.Uniform());
    least.Reset(values);
    EXPECT_EQ(All(&least), Sorted(values)) << levels;
  }
}

TEST(LeastFirst, SortedAndInfiniteNumbers) {
  LeastFirst least;
  const double infinity = std::numeric_limits<double>::infinity();
  Eigen::ArrayXd values = Eigen::ArrayXd::LinSpaced(300, -10, 10);
  values(7) = values(200) = infinity;
  least.Reset(values);
  EXPECT_EQ(All(&least), Sorted(values));
  values.reverseInPlace();
  least.Reset(values);
  EXPECT_EQ(All(&least), Sorted(values));
}

TEST(LeastFirst, PassesOverNaNAndMinusInfinity) {
  LeastFirst least;
  Eigen::ArrayXd values(3);
  values << std::nan(""), 2.0, -std::numeric_limits<double>::infinity();
  least.Reset(values);
  EXPECT_EQ(All(&least), Entries({{2.0, 1}}));
}

TEST(LeastFirst, StartsAnewInBetween) {
  LeastFirst least;
  EXPECT_EQ(least.Front(), nullptr);
  least.Reset(Eigen::ArrayXd::LinSpaced(200, 0, 1));
  ASSERT_NE(least.Front(), nullptr);
  least.Pop();
  const Eigen::ArrayXd values = Eigen::ArrayXd::LinSpaced(100, 3, 2);
  least.Reset(values);
  EXPECT_EQ(All(&least), Sorted(values));
}

}  // namespace
}  // namespace lowlap
