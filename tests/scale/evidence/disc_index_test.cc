#include "lowlap/scale/evidence/internal/disc_index.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

using Entries = std::vector<std::pair<double, int>>;

Entries ByBruteForce(const std::vector<Disc>& discs, const Disc& query) {
  Entries entries;
  for (std::size_t n = 0; n < discs.size(); ++n) {
    const double dx = discs[n].x - query.x, dy = discs[n].y - query.y;
    entries.emplace_back(
        std::sqrt(dx * dx + dy * dy) - discs[n].radius - query.radius,
        static_cast<int>(n));
  }
  std::sort(entries.begin(), entries.end());
  return entries;
}

Entries All(DiscIndex* index, const Disc& query) {
  Entries entries;
  index->Start(query);
  for (; const auto* entry = index->Front(); index->Pop()) {
    entries.push_back(*entry);
  }
  return entries;
}

// Of every size, as long edges among short ones are.
std::vector<Disc> RandomDiscs(int count, Random* random) {
  std::vector<Disc> discs;
  for (int n = 0; n < count; ++n) {
    const double x = random->Uniform(-0.8, 0.8);
    const double y = random->Uniform(-0.5, 0.5);
    discs.push_back({x, y, std::pow(10, random->Uniform(-3, 0))});
  }
  return discs;
}

TEST(DiscIndex, HandsOutAllInTheOrderOfBruteForce) {
  Random random(3);
  for (const int count : {0, 1, 2, 31, 500}) {
    const std::vector<Disc> discs = RandomDiscs(count, &random);
    DiscIndex index(discs);
    for (const Disc& query : RandomDiscs(20, &random)) {
      EXPECT_EQ(All(&index, query), ByBruteForce(discs, query)) << count;
    }
  }
}

TEST(DiscIndex, AnswersQueriesFarOutside) {
  Random random(4);
  const std::vector<Disc> discs = RandomDiscs(200, &random);
  DiscIndex index(discs);
  for (const Disc& query :
       {Disc{50, -3, 0.1}, Disc{-1e4, 1e4, 0}, Disc{0.1, 9, 12}}) {
    EXPECT_EQ(All(&index, query), ByBruteForce(discs, query));
  }
}

// Cells without a width, and many discs of one gap.
TEST(DiscIndex, DiscsOnAPointOrALineAndTiesGoByIndex) {
  for (const bool on_line : {false, true}) {
    std::vector<Disc> discs;
    for (int n = 0; n < 90; ++n) {
      discs.push_back({on_line ? 0.1 * (n % 7) : 0.3, 0.2, 0.1 * (n % 3)});
    }
    DiscIndex index(discs);
    for (const double x : {0.3, -1.0, 0.62}) {
      const Disc query{x, 0.2, 0.05};
      EXPECT_EQ(All(&index, query), ByBruteForce(discs, query));
    }
  }
}

TEST(DiscIndex, LeavesOutWhatIsNotFinite) {
  const double infinity = std::numeric_limits<double>::infinity();
  DiscIndex index({{0, 0, std::nan("")},
                   {infinity, 0, 1},
                   {2, 0, 1},
                   {0, -infinity, infinity}});
  EXPECT_EQ(All(&index, {0, 0, 0}), Entries({{1.0, 2}}));
}

TEST(DiscIndex, StartsAnewInBetween) {
  Random random(5);
  const std::vector<Disc> discs = RandomDiscs(100, &random);
  DiscIndex index(discs);
  EXPECT_EQ(index.Front(), nullptr);
  index.Start({0, 0, 0});
  ASSERT_NE(index.Front(), nullptr);
  index.Pop();
  EXPECT_EQ(All(&index, discs[7]), ByBruteForce(discs, discs[7]));
}

}  // namespace
}  // namespace lowlap
