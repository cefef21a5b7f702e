#include <gtest/gtest.h>

#include "lowlap/matching/internal/lines/line_candidates.h"

namespace lowlap {
namespace {

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
