// The criterion by its closed forms: kinds whose background is known, with
// counts of inliers that are given.

#include "lowlap/scale/internal/criterion/ratio_nfa.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/scale/internal/search/ratio_sweep.h"
#include "scale/even_evidence.h"

namespace lowlap {
namespace {

using testing::Even;
using testing::EvenEvidence;
using testing::EvidenceOf;

using Kinds = std::vector<std::shared_ptr<const EvenEvidence>>;

std::shared_ptr<const EvenEvidence> Units(int count, double width) {
  return Even(std::vector<double>(count, 0.0), width);
}

RatioSupport SupportOf(const Kinds& kinds) {
  return RatioSupport(EvidenceOf({kinds.begin(), kinds.end()}));
}

// So many inliers from a step on.
LadderCounts From(int step, int inliers) {
  LadderCounts counts{};
  std::fill(counts.begin() + step, counts.end(), inliers);
  return counts;
}

// The tests are the units, times 4 for one kind and 8 for two.
RatioNfa Evaluate(const Kinds& kinds, const SupportCounts& counts) {
  const RatioSupport support = SupportOf(kinds);
  return RatioNfaCriterion(support, {}, NfaForm::kCalibrated)
      .Evaluate(0, counts);
}

double Log10Binomial(int n, int k) {
  return (std::lgamma(n + 1) - std::lgamma(k + 1) - std::lgamma(n - k + 1)) /
         std::log(10);
}

// The term of k inliers among n at a step.
double Term(const EvenEvidence& kind, int n, int k, int step) {
  return std::log10(kNumThresholds) + Log10Binomial(n, k) +
         k * kind.Log10Alpha(step);
}

TEST(RatioNfa, OfOneKindCountsAllInliersButTheSample) {
  const auto kind = Units(10, 0.02);
  const RatioNfa nfa = Evaluate({kind}, {From(3, 6)});
  EXPECT_NEAR(nfa.log10_nfa, std::log10(10 * 4) + Term(*kind, 9, 5, 3), 1e-9);
  EXPECT_EQ(nfa.kinds[0].step, 3);
  EXPECT_TRUE(nfa.kinds[0].speaks);
}

// Pairs without a common member, all at ratio 1.
class EvenPairs : public EvenEvidence {
 public:
  EvenPairs(int count, double width) : EvenEvidence({}, width) {
    StartPairs(1);
    for (int n = 0; n < count; ++n) {
      AddPair({CandidateStatus::kValid, 0.0, width}, 0, {n, n});
    }
  }
};

TEST(RatioNfa, OfPairsTheSideThatSaysLessCountsAndBothTellHowFarInliersReach) {
  constexpr int kFine = 1, kCoarse = 6, kPairs = 10;
  const auto kind = std::make_shared<EvenPairs>(kPairs, 0.02);
  SupportCounts counts = {From(kFine, 3), From(kFine, 3)};
  std::fill(counts[1].begin() + kCoarse, counts[1].end(), kPairs);
  const RatioNfa nfa = Evaluate({kind}, counts);
  ASSERT_TRUE(nfa.kinds[0].speaks);
  EXPECT_NEAR(nfa.kinds[0].log10_nfa, Term(*kind, kPairs - 1, 2, kFine), 1e-9);
  EXPECT_EQ(nfa.kinds[0].step, kCoarse);
}

TEST(RatioNfa, OfOneUnitIsTheNumberOfTestsHoweverSureItIs) {
  EXPECT_NEAR(Evaluate({Units(1, 1e-12)}, {From(0, 1)}).log10_nfa,
              std::log10(1 * 4), 1e-9);
  const RatioNfa nfa =
      Evaluate({Units(2, 0.01), Units(1, 1e-12)}, {From(0, 0), From(0, 1)});
  EXPECT_NEAR(nfa.log10_nfa, std::log10(3 * 8), 1e-9);
}

TEST(RatioNfa, OfTwoKindsTakesTheSampleThatIsMissedMost) {
  const auto a = Units(10, 0.02), b = Units(30, 0.01);
  const double sampled_a = Term(*a, 9, 5, 2) + Term(*b, 30, 8, 4);
  const double sampled_b = Term(*a, 10, 6, 2) + Term(*b, 29, 7, 4);
  const RatioNfa nfa = Evaluate({a, b}, {From(2, 6), From(4, 8)});
  EXPECT_NEAR(nfa.log10_nfa,
              std::log10(40 * 8) + std::max(sampled_a, sampled_b), 1e-9);
  EXPECT_NEAR(nfa.kinds[0].log10_nfa + nfa.kinds[1].log10_nfa,
              std::max(sampled_a, sampled_b), 1e-9);
}

// A ratio is not computed from a candidate that does not agree with it.
TEST(RatioNfa, PaysTestsForAKindWithoutInliersAndNoMore) {
  const auto points = Units(10, 0.02);
  const double alone = Evaluate({points}, {From(3, 6)}).log10_nfa;
  const RatioNfa nfa =
      Evaluate({points, Units(1, 1e-6)}, {From(3, 6), From(0, 0)});
  EXPECT_NEAR(nfa.log10_nfa, alone + std::log10(11 / 10.0 * 8 / 4), 1e-9);
  EXPECT_FALSE(nfa.kinds[1].speaks);
}

// The others are witnesses then, all of them.
TEST(RatioNfa, OneUnitThatAgreesIsTheSampleOfTheOthers) {
  const auto points = Units(10, 0.02);
  const RatioNfa nfa =
      Evaluate({points, Units(1, 1e-6)}, {From(3, 6), From(0, 1)});
  EXPECT_NEAR(nfa.log10_nfa, std::log10(11 * 8) + Term(*points, 10, 6, 3),
              1e-9);
  EXPECT_TRUE(nfa.kinds[1].speaks);
  EXPECT_EQ(nfa.kinds[1].log10_nfa, 0);
}

class CertainPairs : public Evidence {
 public:
  CertainPairs() {
    StartPairs(2);
    AddPair({CandidateStatus::kValid, 0.0, 0.1}, 0, {0, 0});
    AddPair({CandidateStatus::kValid, 1.0, 0.1}, 1, {1, 1});
  }
  float ErrorOf(double, int) const override { return 0; }
  std::optional<LadderProbabilities> Background() const override {
    LadderProbabilities log10_alpha;
    log10_alpha.fill(-9);
    return log10_alpha;
  }
};

TEST(RatioNfa, OnePairOfTheSurestTierIsNoWitnessOfItself) {
  TripletEvidence evidence;
  evidence.kinds.push_back({"", std::make_shared<CertainPairs>()});
  const RatioSupport support(evidence);
  const RatioNfaCriterion criterion(support, {}, NfaForm::kCalibrated);
  const LadderCounts one = From(0, 1);
  EXPECT_GE(criterion.Evaluate(0, {one, one, one, one}).log10_nfa, 0);
}

TEST(RatioNfa, IsNeverBelowTheBoundFromCountsThatItDoesNotExceed) {
  Random random(1);
  for (int trial = 0; trial < 300; ++trial) {
    Kinds kinds;
    SupportCounts least, most;
    for (const double width : {1e-6, 0.003, 0.05}) {
      const int n = 1 + static_cast<int>(random.Index(12));
      kinds.push_back(Units(n, width));
      LadderCounts& few = least.emplace_back();
      LadderCounts& many = most.emplace_back();
      for (int step = 0; step < kNumThresholds; ++step) {
        const int before_few = step == 0 ? 0 : few[step - 1];
        const int before_many = step == 0 ? 0 : many[step - 1];
        few[step] = std::min<int>(
            n, before_few + static_cast<int>(random.Index(3)) / 2);
        many[step] =
            std::min<int>(n, std::max(few[step], before_many) +
                                 static_cast<int>(random.Index(3)) / 2);
      }
    }
    const RatioSupport support = SupportOf(kinds);
    const RatioNfaCriterion criterion(support, {}, NfaForm::kCalibrated);
    const RatioNfa nfa = criterion.Evaluate(0, least);
    const RatioNfaBound bound = criterion.Bound(-1, 1, most);
    EXPECT_LE(bound.log10_nfa, nfa.log10_nfa + 1e-9);
    for (std::size_t k = 0; k < kinds.size(); ++k) {
      if (!nfa.kinds[k].speaks) continue;
      EXPECT_LE(bound.tiers[k][nfa.kinds[k].step], nfa.log10_nfa + 1e-9);
    }
  }
}

// The promise: of unrelated ratios, the share whose best NFA is below epsilon
// is below epsilon, also if one of them is far surer than the others.
TEST(RatioNfa, IsBelowEpsilonInFewerThanThatShareOfUnrelatedTriplets) {
  constexpr int kNumTriplets = 2000;
  constexpr double kEpsilon = 0.1;
  for (const double surest : {1e-6, 1e-3, 0.1}) {
    Random random(3);
    const auto unrelated = [&](int count, double width) {
      std::vector<double> log_ratios;
      for (int n = 0; n < count; ++n) {
        log_ratios.push_back(EvenEvidence::kRange * random.Uniform(-0.5, 0.5));
      }
      return Even(log_ratios, width);
    };
    int false_alarms = 0;
    for (int n = 0; n < kNumTriplets; ++n) {
      const RatioSupport support = SupportOf(
          {unrelated(1, surest), unrelated(5, 0.01), unrelated(3, 0.05)});
      const RatioNfaCriterion criterion(support, {}, NfaForm::kCalibrated);
      false_alarms +=
          SweepRatios(support, criterion).nfa.log10_nfa < std::log10(kEpsilon);
    }
    EXPECT_LE(false_alarms, kEpsilon * kNumTriplets) << surest;
  }
}

}  // namespace
}  // namespace lowlap
