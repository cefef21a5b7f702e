#include "lowlap/scale/internal/criterion/ratio_support.h"

#include <gmock/gmock.h>

#include <cmath>
#include <memory>
#include <vector>

#include "scale/even_evidence.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using testing::Even;
using testing::EvidenceOf;

// Three pairs in two tiers; the first two share a unit. Each has an error of
// its own, whatever the ratio is.
class ThreePairs : public Evidence {
 public:
  ThreePairs() {
    StartPairs(2);
    const RatioCandidate ratio{CandidateStatus::kValid, 0.5, 0.1};
    AddPair(ratio, 0, {0, 0});
    AddPair(ratio, 0, {0, 1});
    AddPair(ratio, 1, {1, 1});
  }
  float ErrorOf(double, int candidate) const override {
    return std::array{5.0f, 0.2f, 1.2f}[candidate];
  }
};

TEST(RatioSupport, LeavesOutKindsWithoutCandidates) {
  const RatioSupport support(
      EvidenceOf({nullptr, Even({}, 1), Even({1}, 1), nullptr,
                  std::make_shared<ThreePairs>()}));
  ASSERT_EQ(support.num_kinds(), 2);
  EXPECT_EQ(support.PlaceOf(0), 2);
  EXPECT_EQ(support.PlaceOf(1), 4);
  EXPECT_EQ(support.FirstTier(1), 1);
  EXPECT_EQ(support.FirstCounter(1), 1);
  EXPECT_EQ(support.num_tiers(), 1 + 2);
  EXPECT_EQ(support.num_counters(), 1 + 2 * 2);
}

TEST(RatioSupport, SortsTheHypothesesOfAllKinds) {
  const RatioSupport support(
      EvidenceOf({Even({0.3, -1, 0.3}, 1), Even({0.1, 0.3}, 1)}));
  std::vector<std::vector<double>> hypotheses;
  for (const Hypothesis& hypothesis : support.hypotheses()) {
    hypotheses.push_back(
        {hypothesis.log_ratio, 1.0 * hypothesis.kind, 1.0 * hypothesis.index});
  }
  EXPECT_THAT(hypotheses,
              ElementsAre(ElementsAre(-1, 0, 1), ElementsAre(0.1, 1, 0),
                          ElementsAre(0.3, 0, 0), ElementsAre(0.3, 0, 2),
                          ElementsAre(0.3, 1, 1)));
  EXPECT_THAT(support.SortedLogRatios(0, 3), ElementsAre(-1, 0.3, 0.3));
  EXPECT_THAT(support.SortedLogRatios(0, 1), ElementsAre(0.3));
}

TEST(RatioSupport, CountsErrorsBelowEveryThreshold) {
  const RatioSupport support(EvidenceOf({Even({0, 1, 3}, 1), Even({2}, 0.1)}));
  SupportWorkspace workspace;
  const SupportCounts& counts = support.Count(1, &workspace);
  for (int step = 0; step < kNumThresholds; ++step) {
    const double threshold = LadderThresholdPx(step);
    // Errors 1, 0 and 2; and 10.
    EXPECT_EQ(counts[0][step], 1 + (threshold > 1.0001) + (threshold > 2.0001))
        << threshold;
    EXPECT_EQ(counts[1][step], threshold > 10.0001 ? 1 : 0) << threshold;
  }
}

TEST(RatioSupport, CountsAUnitOfPairsOnceByTheLeastError) {
  const RatioSupport support(EvidenceOf({std::make_shared<ThreePairs>()}));
  EXPECT_EQ(support.TierOf(0, 1), 0);
  EXPECT_EQ(support.TierOf(0, 2), 1);
  SupportWorkspace workspace;
  const SupportCounts& counts = support.Count(0.5, &workspace);
  for (int step = 0; step < kNumThresholds; ++step) {
    const double threshold = LadderThresholdPx(step);
    const int pair1 = threshold > 0.2, pair2 = threshold > 1.2;
    const int pair0 = threshold > 5;
    EXPECT_EQ(counts[0][step], pair1);          // nearest tier, first side
    EXPECT_EQ(counts[1][step], pair1 + pair0);  // its other side
    EXPECT_EQ(counts[2][step], pair1 + pair2);
    EXPECT_EQ(counts[3][step], pair1 + pair0);
  }
}

TEST(RatioSupport, BoundsTheErrorsOfAnInterval) {
  const RatioSupport support(EvidenceOf({Even({0, 1, 3}, 1), Even({2}, 0.1)}));
  KindErrors least, most;
  support.Bound(0.5, 2.5, &least, &most);
  EXPECT_THAT(least[0], ElementsAre(::testing::FloatNear(0.5f, 1e-5f),
                                    ::testing::FloatNear(0, 1e-5f),
                                    ::testing::FloatNear(0.5f, 1e-5f)));
  EXPECT_THAT(most[0], ElementsAre(::testing::FloatNear(2.5f, 1e-5f),
                                   ::testing::FloatNear(1.5f, 1e-5f),
                                   ::testing::FloatNear(2.5f, 1e-5f)));
  EXPECT_NEAR(most[1][0], 15, 1e-4);
}

}  // namespace
}  // namespace lowlap
