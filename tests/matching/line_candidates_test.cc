#include "lowlap/matching/internal/lines/line_candidates.h"

#include <gtest/gtest.h>

#include <bitset>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

TEST(HammingDistances, CountsTheBitsThatDiffer) {
  Random random(1);
  std::vector<LineDescriptor> all(37);
  for (LineDescriptor& descriptor : all) {
    for (auto& byte : descriptor) {
      byte = static_cast<std::uint8_t>(random.Index(256));
    }
  }
  all[5] = all[0];
  for (std::size_t k = 0; k < all[6].size(); ++k) {
    all[6][k] = static_cast<std::uint8_t>(~all[0][k]);
  }
  std::vector<int> distances(3, -1);
  HammingDistances(all[0], all, &distances);
  ASSERT_EQ(distances.size(), all.size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    std::size_t expected = 0;
    for (std::size_t k = 0; k < all[n].size(); ++k) {
      expected += std::bitset<8>(all[0][k] ^ all[n][k]).count();
    }
    EXPECT_EQ(distances[n], static_cast<int>(expected)) << n;
  }
  EXPECT_EQ(distances[5], 0);
  EXPECT_EQ(distances[6], 256);
  HammingDistances(all[0], {}, &distances);
  EXPECT_TRUE(distances.empty());
}

TEST(RelaxScores, TakesTheBestOfEachNeighbourAndTheMeanOfAll) {
  // One neighbour with two candidates, one with none that agrees.
  const std::vector<std::vector<std::vector<Support>>> supports = {
      {{{1, 0.5}, {2, 0.9}}, {}}, {}, {}};
  const auto scores = RelaxScores({1, 0.8, 0.2}, supports, 0.1, 1);
  const double support = 0.5 * 0.5 * 0.8;
  EXPECT_DOUBLE_EQ(scores[0], support / (support + 0.1));
  EXPECT_EQ(scores[1], 0);
  EXPECT_EQ(scores[2], 0);
}

TEST(RelaxScores, KeepsThoseWhoSupportEachOther) {
  const std::vector<std::vector<std::vector<Support>>> supports = {
      {{{1, 1}}}, {{{0, 1}}}, {{{0, 0.05}}}};
  const auto scores = RelaxScores({0.5, 0.5, 0.5}, supports, 0.1, 20);
  EXPECT_GT(scores[0], 0.8);
  EXPECT_GT(scores[1], 0.8);
  EXPECT_LT(scores[2], 0.4);
}

TEST(RelaxScores, LeavesTheScoresWithoutIterations) {
  EXPECT_EQ(RelaxScores({0.3}, {{}}, 0.1, 0), std::vector<double>{0.3});
}

}  // namespace
}  // namespace lowlap
