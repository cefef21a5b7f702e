#include "lowlap/averaging/centers/internal/length_balance.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>
#include <vector>

#include "averaging/random_problem.h"

namespace lowlap {
namespace {

using ::testing::DoubleEq;
using ::testing::Each;
using ::testing::ElementsAre;
using ::testing::IsEmpty;

const ErrorLimits kLengthLimits = {5.0, RadFromDeg(1.0)};

// Six views, all pairs: 0-1, 0-2, ... 4-5.
RandomProblem SixViews() {
  constexpr std::size_t num_views = 6;
  std::vector<std::pair<std::size_t, std::size_t>> edges;
  for (std::size_t a = 0; a < num_views; ++a) {
    for (std::size_t b = a + 1; b < num_views; ++b) edges.emplace_back(a, b);
  }
  return MakeRandomProblem(num_views, edges, 3);
}

TranslationSolution Truth(const RandomProblem& made) {
  TranslationSolution solution;
  solution.component.assign(made.centers.size(), 0);
  solution.center_in_world = made.centers;
  solution.num_components = 1;
  return solution;
}

// Lengths are wrong by a factor of e^error.
void Stretch(const std::vector<std::size_t>& edges, double error,
             RandomProblem* made) {
  std::vector<double> errors(made->problem.edges.size(), 0);
  for (const std::size_t edge : edges) errors[edge] = error;
  for (RatioMeasurement& ratio : made->problem.ratios) {
    ratio.log_ratio += errors[ratio.target] - errors[ratio.reference];
  }
}

std::vector<std::size_t> Contradicted(const RandomProblem& made) {
  return ContradictedLengths(made.problem, Truth(made), kLengthLimits, 0);
}

TEST(LengthBalance, RatiosSpeakForEdgesToBelievedOnes) {
  RandomProblem made = SixViews();
  made.problem.ratios.clear();
  made.AddRatio(0, 1);       // 0-1, 0-2
  made.AddRatio(1, 2, 0.2);  // 0-2, 0-3
  made.problem.ratios[0].log10_nfa = -9;
  made.problem.ratios[1].log10_nfa = -5;
  std::vector<char> is_believed(made.problem.edges.size(), 0);
  is_believed[1] = 1;
  const std::vector<double> balance =
      LengthBalance(made.problem, Truth(made), kLengthLimits, is_believed);
  EXPECT_DOUBLE_EQ(balance[0], 10);
  EXPECT_DOUBLE_EQ(balance[1], 0);
  EXPECT_DOUBLE_EQ(balance[2], -6);
  EXPECT_THAT(std::vector<double>(balance.begin() + 3, balance.end()),
              Each(DoubleEq(0)));
}

TEST(LengthBalance, WhatIsNotPlacedIsNotWeighed) {
  const RandomProblem made = SixViews();
  TranslationSolution solution = Truth(made);
  solution.component[0] = -1;
  const std::vector<char> is_believed(made.problem.edges.size(), 1);
  const std::vector<double> balance =
      LengthBalance(made.problem, solution, kLengthLimits, is_believed);
  for (std::size_t n = 0; n < balance.size(); ++n) {
    EXPECT_EQ(balance[n] > 0, made.problem.edges[n].first != 0) << n;
  }
}

TEST(ContradictedLengths, OfTrueRatiosThereAreNone) {
  EXPECT_THAT(Contradicted(SixViews()), IsEmpty());
  EXPECT_THAT(ContradictedLengths({}, {}, kLengthLimits, 0), IsEmpty());
}

// 0-1, 0-3 and 0-5 are wrong alike, as of windows that are one too near, and
// bear each other out; 0-2 and 0-4, which are right, have more ratios to those
// three at view 0 than to each other.
TEST(ContradictedLengths, WhatIsWrongAlikeDoesNotDiscreditTheOthers) {
  RandomProblem made = SixViews();
  Stretch({0, 2, 4}, -0.4, &made);
  EXPECT_THAT(Contradicted(made), ElementsAre(0, 2, 4));
}

TEST(ContradictedLengths, LittleIsNoContradiction) {
  RandomProblem made = SixViews();
  Stretch({0, 2, 4}, -0.03, &made);
  EXPECT_THAT(Contradicted(made), IsEmpty());
}

// It contradicts already.
TEST(ContradictedLengths, AWrongDirectionIsLeftToTheDirections) {
  RandomProblem made = SixViews();
  Stretch({0}, -0.4, &made);
  made.problem.edges[0].direction_in_world *= -1;
  EXPECT_THAT(Contradicted(made), IsEmpty());
}

}  // namespace
}  // namespace lowlap
