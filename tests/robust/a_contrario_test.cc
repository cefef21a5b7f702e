#include "lowlap/robust/internal/a_contrario.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/robust/internal/log_combinatorics.h"

namespace lowlap {
namespace {

constexpr BackgroundLaw kLaw = {1e-3, 1};

TEST(BackgroundLaw, HasTheStatedValuesAndIsCappedAtOne) {
  const BackgroundLaw line = BackgroundLaw::PointToLine(3e6, 2500);
  EXPECT_DOUBLE_EQ(line.Alpha(1.5), 2 * 2500 * 1.5 / 3e6);
  EXPECT_EQ(line.Alpha(1e9), 1.0);
  const BackgroundLaw point = BackgroundLaw::PointToPoint(3e6);
  EXPECT_NEAR(point.Alpha(2), 3.14159265358979 * 4 / 3e6, 1e-15);
}

TEST(AContrarioLadder, CoversTheRangeWithFineSteps) {
  const AContrarioLadder ladder(100, 5, 10, kLaw, 0.1, 16);
  EXPECT_NEAR(ladder.Threshold(0), 0.1, 1e-6);
  EXPECT_LE(ladder.Threshold(ladder.NumSteps() - 1), 16.0 + 1e-6);
  EXPECT_GT(ladder.Threshold(ladder.NumSteps() - 1), 16.0 / 1.13);
  for (int step = 1; step < ladder.NumSteps(); ++step) {
    const double ratio = ladder.Threshold(step) / ladder.Threshold(step - 1);
    EXPECT_GT(ratio, 1.05);
    EXPECT_LT(ratio, 1.13);
  }
}

TEST(AContrarioLadder, FindsTheStepOfAResidualLikeALinearSearch) {
  const AContrarioLadder ladder(100, 5, 10, kLaw, 0.1, 16);
  Random random(1);
  for (int trial = 0; trial < 10000; ++trial) {
    const float squared =
        static_cast<float>(std::pow(10.0, random.Uniform(-4, 4)));
    int step = 0;
    while (step < ladder.NumSteps() &&
           squared > static_cast<float>(ladder.Threshold(step) *
                                        ladder.Threshold(step))) {
      ++step;
    }
    EXPECT_EQ(ladder.Step(squared), step) << squared;
  }
  EXPECT_EQ(ladder.Step(0), 0);
  EXPECT_EQ(ladder.Step(std::numeric_limits<float>::infinity()),
            ladder.NumSteps());
  EXPECT_EQ(ladder.Step(std::numeric_limits<float>::quiet_NaN()),
            ladder.NumSteps());
}

TEST(AContrarioLadder, ComputesTheNfaOfTheFormula) {
  const int n = 60;
  const AContrarioLadder ladder(n, 5, 10, kLaw, 0.1, 16);
  for (const int k : {6, 20, 59, 60}) {
    for (const int step : {0, 10, ladder.NumSteps() - 1}) {
      const double expected =
          std::log10(ladder.NumSteps() * 10.0) + Log10Binomial(n, k) +
          Log10Binomial(k, 5) +
          (k - 5) * std::log10(kLaw.Alpha(ladder.Threshold(step)));
      EXPECT_NEAR(ladder.Log10Nfa(k, step), expected, 1e-9);
    }
  }
  EXPECT_EQ(ladder.Log10Nfa(5, 0), std::numeric_limits<double>::infinity());
}

TEST(AContrarioLadder, ScoresLikeBruteForceOverAllSteps) {
  Random random(2);
  const int n = 200;
  const AContrarioLadder ladder(n, 5, 10, kLaw, 0.1, 16);
  std::vector<float> squared(n);
  for (int i = 0; i < n; ++i) {
    const double r = i < 80 ? random.Gaussian(0.5) : random.Uniform(0, 1000);
    squared[i] = static_cast<float>(r * r);
  }
  AContrarioScore best{1e300, 0, 0};
  for (int step = 0; step < ladder.NumSteps(); ++step) {
    const int k = static_cast<int>(
        std::count_if(squared.begin(), squared.end(),
                      [&](float s) { return ladder.Step(s) <= step; }));
    const double nfa = ladder.Log10Nfa(k, step);
    if (nfa < best.log10_nfa) best = {nfa, ladder.Threshold(step), k};
  }
  const AContrarioScore score = ladder.Score(squared);
  EXPECT_DOUBLE_EQ(score.log10_nfa, best.log10_nfa);
  EXPECT_EQ(score.num_inliers, best.num_inliers);
  EXPECT_LT(score.log10_nfa, -50);
  EXPECT_NEAR(score.num_inliers, 80, 8);
  EXPECT_GT(score.threshold, 0.7);
  EXPECT_LT(score.threshold, 2.5);
}

TEST(AContrarioLadder, FindsNothingMeaningfulInNoise) {
  Random random(3);
  const int n = 100;
  const AContrarioLadder ladder(n, 5, 10, kLaw, 0.1, 16);
  std::vector<float> squared(n);
  for (int trial = 0; trial < 2000; ++trial) {
    for (float& s : squared) {
      const double r = random.Uniform(0, 1000);
      s = static_cast<float>(r * r);
    }
    EXPECT_GE(ladder.Score(squared).log10_nfa, 0);
  }
}

TEST(AContrarioLadder, TellsHowManyInliersBeatAScore) {
  const int n = 150;
  const AContrarioLadder ladder(n, 5, 10, kLaw, 0.1, 16);
  for (const double target : {0.0, -20.0, -100.0, -1e6}) {
    for (int step = 0; step < ladder.NumSteps(); step += 7) {
      const int k = ladder.InliersToBeat(target, step);
      if (k <= n) {
        EXPECT_LT(ladder.Log10Nfa(k, step), target);
      }
      EXPECT_GE(ladder.Log10Nfa(k - 1, step), target);
    }
  }
  EXPECT_GT(ladder.InliersToBeat(-1e6, 0), n);
}

TEST(AContrarioLadder, RaisesAlphaToTheMeasuredBackground) {
  const AContrarioLadder ladder(50, 2, 1, kLaw, 0.1, 16);
  std::vector<int> background(ladder.NumSteps() + 1, 0);
  background.front() = 100;  // a tenth of the wrong data at the first step
  background.back() = 899;
  const AContrarioLadder raised = ladder.WithBackground(background);
  const double change = (std::log10(0.101) - std::log10(kLaw.Alpha(0.1))) * 8;
  EXPECT_NEAR(raised.Log10Nfa(10, 0) - ladder.Log10Nfa(10, 0), change, 1e-6);
  background.assign(background.size(), 0);
  background.back() = 1000000;
  const AContrarioLadder same = ladder.WithBackground(background);
  EXPECT_EQ(same.Log10Nfa(10, 0), ladder.Log10Nfa(10, 0));
}

}  // namespace
}  // namespace lowlap
