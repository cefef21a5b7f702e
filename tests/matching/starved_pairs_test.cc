#include "lowlap/matching/internal/starved_pairs.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

std::map<ViewPair, PairMatches> Matches(
    const std::map<ViewPair, std::size_t>& counts) {
  std::map<ViewPair, PairMatches> matches;
  for (const auto& [pair, count] : counts) {
    matches[pair].points.resize(count);
  }
  return matches;
}

TEST(SelectStarvedPairsTest, TakesThoseOfViewsWithFewGoodPairs) {
  // 0 to 3 are joined to each other, 4 to none of them.
  const auto matches = Matches({{{0, 1}, 500},
                                {{0, 2}, 100},
                                {{0, 3}, 400},
                                {{1, 2}, 300},
                                {{1, 3}, 20},
                                {{2, 3}, 200},
                                {{3, 4}, 99},
                                {{0, 4}, 10}});
  EXPECT_THAT(SelectStarvedPairs(matches, {}),
              ElementsAre(ViewPair{0, 4}, ViewPair{1, 3}, ViewPair{3, 4}));
  TiltedPointOptions options;
  options.enough_pairs = 2;
  EXPECT_THAT(SelectStarvedPairs(matches, options),
              ElementsAre(ViewPair{0, 4}, ViewPair{3, 4}));
  options.max_partners = 1;
  EXPECT_THAT(SelectStarvedPairs(matches, options),
              ElementsAre(ViewPair{3, 4}));
  options.starved_below = 0;
  EXPECT_THAT(SelectStarvedPairs(matches, options), IsEmpty());
}

}  // namespace
}  // namespace lowlap
