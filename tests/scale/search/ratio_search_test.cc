#include "lowlap/scale/internal/search/ratio_search.h"

#include <gmock/gmock.h>

#include <cmath>
#include <map>
#include <numeric>
#include <vector>

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

struct Score {
  double value;
  bool BetterThan(const Score& other) const { return value < other.value; }
};

std::vector<Hypothesis> EvenHypotheses(int count) {
  std::vector<Hypothesis> hypotheses;
  for (int n = 0; n < count; ++n) {
    hypotheses.push_back({static_cast<double>(n), 1, n % 3 == 0 ? 0 : 1, n});
  }
  return hypotheses;
}

TEST(CoarseSubset, IsAllOfFewAndALimitedNumberOfMany) {
  std::vector<int> all(kCoarseHypotheses);
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(CoarseSubset(EvenHypotheses(kCoarseHypotheses)), all);

  const auto hypotheses = EvenHypotheses(3000);
  const std::vector<int> subset = CoarseSubset(hypotheses);
  std::map<int, int> of_kind;
  for (const int index : subset) ++of_kind[hypotheses[index].kind];
  EXPECT_EQ(of_kind[0], kCoarseHypotheses);
  EXPECT_EQ(of_kind[1], kCoarseHypotheses);
  EXPECT_TRUE(std::is_sorted(subset.begin(), subset.end()));
}

TEST(CoarseSubset, IsTheSameReadFromEitherEnd) {
  std::vector<Hypothesis> hypotheses(1001);
  const std::vector<int> subset = CoarseSubset(hypotheses);
  for (std::size_t n = 0; n < subset.size(); ++n) {
    EXPECT_EQ(subset[n] + subset[subset.size() - 1 - n], 1000);
  }
}

TEST(IndicesBetween, AreStrictlyBetweenAndLimited) {
  EXPECT_THAT(IndicesBetween(3, 4), IsEmpty());
  EXPECT_THAT(IndicesBetween(-1, 2), ElementsAre(0, 1));
  const std::vector<int> many = IndicesBetween(10, 1000);
  EXPECT_EQ(static_cast<int>(many.size()), kMaxAroundOne);
  EXPECT_GT(many.front(), 10);
  EXPECT_LT(many.back(), 1000);
}

TEST(SearchRatios, FindsTheBestOfAllExhaustively) {
  const auto hypotheses = EvenHypotheses(3000);
  const auto score = [](int index) { return Score{index == 1234 ? 0.0 : 1.0}; };
  EXPECT_EQ(SearchRatios(hypotheses, true, score), 1234);
}

TEST(SearchRatios, FindsAModeThatIsWideEnough) {
  const auto hypotheses = EvenHypotheses(3000);
  for (const int mode : {50, 700, 1999, 2980}) {
    const auto score = [&](int index) {
      return Score{std::min(40.0, std::abs(1.0 * index - mode))};
    };
    EXPECT_NEAR(SearchRatios(hypotheses, false, score), mode, 1) << mode;
  }
}

TEST(SearchRatios, GivesTiesToTheSurerAndThenToTheLower) {
  auto hypotheses = EvenHypotheses(10);
  const auto same = [](int) { return Score{1}; };
  EXPECT_EQ(SearchRatios(hypotheses, false, same), 0);
  hypotheses[4].log_ratio_stddev = hypotheses[7].log_ratio_stddev = 0.5;
  EXPECT_EQ(SearchRatios(hypotheses, false, same), 4);
}

}  // namespace
}  // namespace lowlap
