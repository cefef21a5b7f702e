#include "lowlap/robust/internal/nfa.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/robust/internal/log_combinatorics.h"

namespace lowlap {
namespace {

constexpr double kArea = 1200.0 * 800.0;
const double kDiagonal = std::hypot(1200.0, 800.0);

TEST(ThresholdLadder, StepIsTheFirstThresholdAboveTheError) {
  Random random(1);
  for (int trial = 0; trial < 10000; ++trial) {
    const float error = static_cast<float>(std::exp(random.Uniform(-5.0, 5.0)));
    int expected = 0;
    while (expected < kNumThresholds && error >= LadderThresholdPx(expected)) {
      ++expected;
    }
    ASSERT_EQ(LadderStep(error), expected) << error;
  }
  EXPECT_EQ(LadderStep(0.0f), 0);
  EXPECT_EQ(LadderStep(std::numeric_limits<float>::infinity()), kNumThresholds);
  EXPECT_EQ(LadderStep(std::numeric_limits<float>::quiet_NaN()),
            kNumThresholds);
  EXPECT_DOUBLE_EQ(LadderThresholdPx(0), 0.125);
  EXPECT_DOUBLE_EQ(LadderThresholdPx(kNumThresholds - 1), 16.0);
}

TEST(ThresholdLadder, CountsAreCumulative) {
  const std::vector<float> errors = {0.1f, 0.2f, 0.2f, 3.5f, 100.0f};
  const LadderCounts counts =
      CountOnLadder(errors.data(), static_cast<int>(errors.size()));
  EXPECT_EQ(counts[0], 1);  // 0.125
  EXPECT_EQ(counts[1], 1);  // 0.1875
  EXPECT_EQ(counts[2], 3);  // 0.25
  EXPECT_EQ(counts[kNumThresholds - 1], 4);
}

TEST(LogFactorials, BinomialsEqualTheGammaFunctions) {
  const LogFactorials factorials(500);
  for (int n = 0; n <= 500; n += 17) {
    for (int k = 0; k <= n; k += 5) {
      EXPECT_NEAR(factorials.Log10Binomial(n, k), Log10Binomial(n, k), 1e-9);
    }
  }
}

TEST(BinomialTail, IsTheSumOfItsTerms) {
  // 4 or 5 heads of 5: 6 of 32.
  EXPECT_NEAR(Log10BinomialTail(5, 4, 0.5), std::log10(6.0 / 32), 1e-12);
  EXPECT_NEAR(Log10BinomialTail(3, 3, 0.1), -3, 1e-12);
  EXPECT_NEAR(Log10BinomialTail(2000, 2000, 0.5), 2000 * std::log10(0.5), 1e-9);
  EXPECT_EQ(Log10BinomialTail(7, 0, 0.5), 0);
  EXPECT_EQ(Log10BinomialTail(0, 0, 0.5), 0);
  EXPECT_LE(Log10BinomialTail(400, 1, 0.9), 0);
  EXPECT_EQ(Log10BinomialTail(7, 8, 0.5),
            -std::numeric_limits<double>::infinity());
}

TEST(BestOfPartners, IsTheComplementOfAllMissing) {
  EXPECT_NEAR(BestOfPartners(0.1, 1), 0.1, 1e-15);
  EXPECT_NEAR(BestOfPartners(0.1, 10), 1 - std::pow(0.9, 10), 1e-14);
  EXPECT_NEAR(BestOfPartners(1e-12, 10), 1e-11, 1e-20);
  EXPECT_EQ(BestOfPartners(1.5, 3), 1.0);
}

TEST(CalibratedValues, IsTheMinimumOverTheSteps) {
  const LogFactorials factorials(20);
  LadderCounts counts{};
  LadderProbabilities log10_alpha;
  log10_alpha.fill(-0.5);
  for (int step = 4; step < kNumThresholds; ++step) counts[step] = 9;
  counts[6] = counts[7] = 12;
  log10_alpha[6] = -3;
  const NfaTerm term =
      LeastOverSteps(CalibratedValues(factorials, 20, counts, log10_alpha, 1));
  EXPECT_EQ(term.step, 6);
  EXPECT_NEAR(term.log10_nfa, std::log10(15.0) + Log10Binomial(19, 11) - 3 * 11,
              1e-9);
}

TEST(CalibratedValues, IsCappedAtOneAndProbabilitiesToo) {
  const LogFactorials factorials(20);
  LadderCounts counts{};
  counts.fill(20);
  LadderProbabilities log10_alpha;
  log10_alpha.fill(2.0);  // alpha = 100
  const NfaTerm term =
      LeastOverSteps(CalibratedValues(factorials, 20, counts, log10_alpha, 0));
  EXPECT_EQ(term.log10_nfa, 0.0);
  EXPECT_NEAR(term.uncapped, std::log10(15.0), 1e-12);
  EXPECT_EQ(LeastOverSteps(CalibratedValues(LogFactorials(1), 1, {}, {}, 1))
                .log10_nfa,
            0.0);
}

TEST(CalibratedPairValues, IsThatOfTheSideThatSaysLess) {
  const LogFactorials factorials(30);
  LadderCounts counts{};
  counts.fill(10);
  LadderProbabilities log10_alpha;
  log10_alpha.fill(-2);
  const NfaTerm one =
      LeastOverSteps(CalibratedValues(factorials, 30, counts, log10_alpha, 1));
  const auto pair_of = [&](const LadderCounts& a, const LadderCounts& b) {
    return CalibratedPairValues(factorials, 30, a, log10_alpha, 30, b,
                                log10_alpha, 1);
  };
  const NfaTerm pair = LeastOverSteps(pair_of(counts, counts).log10_nfa);
  EXPECT_NEAR(pair.log10_nfa, one.log10_nfa, 1e-12);
  LadderCounts one_line{};
  one_line.fill(1);
  // One line paired with a bundle: it is the sample of all of them.
  const PairLadderValues star = pair_of(one_line, counts);
  EXPECT_NEAR(LeastOverSteps(star.log10_nfa).uncapped, std::log10(15.0), 1e-12);
  EXPECT_EQ(LeastOverSteps(star.log10_nfa).log10_nfa, 0);
  // Yet of ratios that chance explains it is before one line and another.
  EXPECT_LT(star.order[0], pair_of(one_line, one_line).order[0]);
}

// As the least value over counts in an interval of ratios must.
TEST(CalibratedPairValues, NeverRiseWithACountOnceTheySpeak) {
  const int n = 40;
  const LogFactorials factorials(n);
  LadderProbabilities log10_alpha;
  log10_alpha.fill(-1.2);
  const auto speaks = [&](int num_a, int num_b) {
    LadderCounts a{}, b{};
    a.fill(num_a);
    b.fill(num_b);
    const PairLadderValues values = CalibratedPairValues(
        factorials, n, a, log10_alpha, n, b, log10_alpha, 1);
    return LeastOverSteps(values.log10_nfa).log10_nfa;
  };
  for (int a = 1; a <= n; ++a) {
    for (int b = 1; b < n; ++b) EXPECT_LE(speaks(a, b + 1), speaks(a, b));
  }
}

// Against the printed formulas with the k-th error at the threshold.
TEST(PaperTerms, AreThePrintedFormulas) {
  const int n = 12;
  const LogFactorials factorials(n);
  LadderCounts counts{};
  const int step = 6;  // 1 pixel
  for (int s = step; s < kNumThresholds; ++s) counts[s] = 8;
  const double e = LadderThresholdPx(step);
  EXPECT_NEAR(PaperPointTerm(factorials, n, counts, kArea).log10_nfa,
              std::log10((n - 1) * 8.0) + Log10Binomial(n, 8) +
                  7 * std::log10(M_PI * e * e / kArea),
              1e-9);
  EXPECT_NEAR(PaperLineTerm(factorials, n, counts, kArea, kDiagonal).log10_nfa,
              std::log10((n - 1) * 8.0) + Log10Binomial(n, 8) +
                  7 * std::log10(2 * kDiagonal * e / kArea),
              1e-9);
  EXPECT_NEAR(PaperCoplanarTerm(factorials, n, counts, kArea, 10).log10_nfa,
              std::log10((n - 2) * n * 10.0) + Log10Binomial(n, 6) +
                  6 * std::log10(M_PI * e * e / kArea),
              1e-9);
  EXPECT_EQ(PaperPointTerm(factorials, 1, counts, kArea).log10_nfa, 0.0);
}

// 200 lines, each with the least of ten errors that obey the one-dimensional
// law: the printed form takes this noise for a certainty, the calibrated one
// does not.
TEST(CalibratedValues, DoesNotMistakeTheBestOfTenPartnersForEvidence) {
  constexpr int kLines = 200, kPartners = 10, kTrials = 100;
  const LogFactorials factorials(kLines);
  LadderProbabilities log10_alpha;
  for (int step = 0; step < kNumThresholds; ++step) {
    const double alpha = 2 * kDiagonal * LadderThresholdPx(step) / kArea;
    log10_alpha[step] = std::log10(BestOfPartners(alpha, kPartners));
  }
  int false_alarms = 0;
  double worst_paper = -1e9;
  for (int trial = 0; trial < kTrials; ++trial) {
    Random random(7, trial);
    std::vector<float> errors(kLines, 1e9f);
    for (float& error : errors) {
      for (int partner = 0; partner < kPartners; ++partner) {
        const double e = random.Uniform() * kArea / (2 * kDiagonal);
        error = std::min(error, static_cast<float>(e));
      }
    }
    const LadderCounts counts = CountOnLadder(errors.data(), kLines);
    // An NFA below x happens with a probability of at most x.
    false_alarms += LeastOverSteps(CalibratedValues(factorials, kLines, counts,
                                                    log10_alpha, 0))
                        .log10_nfa < -1;
    worst_paper =
        std::max(worst_paper,
                 PaperCoplanarTerm(factorials, kLines, counts, kArea, kPartners)
                     .log10_nfa);
  }
  EXPECT_LE(false_alarms, kTrials / 10);
  EXPECT_LT(worst_paper, -50);
}

}  // namespace
}  // namespace lowlap
