// A kind of evidence from outside: odometry knows the lengths of some
// baselines, with a relative deviation, and nothing of images.

#include "lowlap/scale/evidence/evidence_kind.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "lowlap/scale/scale_ratios.h"
#include "scale/row_of_views.h"
#include "scale/synthetic_triplet.h"

namespace lowlap {
namespace {

using testing::RowOfViews;

// One candidate; its error is in standard deviations. An unrelated ratio is
// anything from a hundredth to a hundred.
class OdometryEvidence : public Evidence {
 public:
  OdometryEvidence(double log_ratio, double stddev) {
    AddCandidate({CandidateStatus::kValid, log_ratio, stddev});
  }
  float ErrorOf(double tau, int candidate) const override {
    const RatioCandidate& ratio = ratios()[candidate];
    return static_cast<float>(std::abs(std::log(tau) - ratio.log_ratio) /
                              ratio.log_ratio_stddev);
  }
  double NumTests() const override { return 1; }
  std::optional<LadderProbabilities> Background() const override {
    LadderProbabilities log10_alpha;
    for (int step = 0; step < kNumThresholds; ++step) {
      const double reach =
          LadderThresholdPx(step) * ratios()[0].log_ratio_stddev;
      log10_alpha[step] =
          std::log10(std::min(1.0, 2 * reach / (2 * std::log(100.0))));
    }
    return log10_alpha;
  }
};

class Odometry : public EvidenceKind {
 public:
  using Lengths = std::map<ViewPair, double>;
  Odometry(Lengths lengths, double stddev)
      : lengths_(std::move(lengths)), stddev_(stddev) {}

  std::string Name() const override { return "odometry"; }
  std::unique_ptr<Evidence> Gather(const TripletView& triplet) const override {
    const auto [i, j, k] = triplet.views;
    const auto ij = lengths_.find({std::min(i, j), std::max(i, j)});
    const auto jk = lengths_.find({std::min(j, k), std::max(j, k)});
    if (ij == lengths_.end() || jk == lengths_.end()) return nullptr;
    return std::make_unique<OdometryEvidence>(std::log(jk->second / ij->second),
                                              std::sqrt(2.0) * stddev_);
  }

 private:
  Lengths lengths_;
  double stddev_;
};

// Kinds whose features have been told apart, and odometry.
EvidenceKinds With(std::shared_ptr<const EvidenceKind> odometry) {
  EvidenceKinds kinds = *EvidenceRegistry::BuiltIn().Make({}, {});
  kinds.push_back(std::move(odometry));
  return kinds;
}

ScaleRatio RatioOf(const Scene& scene, const ViewTriplet& views,
                   const EvidenceKinds& kinds) {
  const auto ratios = EstimateScaleRatios(
      scene, {views}, AContrarioScaleEstimator(kinds), RunContext());
  EXPECT_TRUE(ratios.has_value());
  return ratios->front();
}

TEST(EvidenceKind, OfOnesOwnIsListedBesideTheBuiltInOnes) {
  const RowOfViews row;
  const ScaleRatio ratio =
      RatioOf(row.scene, {0, 1, 2},
              With(std::make_shared<Odometry>(row.baselines, 0.01)));
  EXPECT_EQ(ratio.verdict, RatioVerdict::kMeaningful);
  const KindSupport* odometry = ratio.FindKind("odometry");
  ASSERT_NE(odometry, nullptr);
  EXPECT_EQ(odometry->candidates, 1);
  EXPECT_EQ(odometry->inliers, 1);
  EXPECT_LE(odometry->log10_nfa, 0);  // 0: its one unit is the sample
  EXPECT_GT(odometry->information_share, 0);
  EXPECT_NE(ratio.FindKind("points"), nullptr);
  EXPECT_EQ(&ratio.kinds.back(), odometry);
}

TEST(EvidenceKind, SaysNothingAboutTripletsThatItDoesNotKnow) {
  const RowOfViews row;
  const auto kinds =
      With(std::make_shared<Odometry>(Odometry::Lengths{{{0, 1}, 1}}, 0.01));
  const ScaleRatio ratio = RatioOf(row.scene, {0, 1, 2}, kinds);
  const ScaleRatio without =
      RatioOf(row.scene, {0, 1, 2}, *EvidenceRegistry::BuiltIn().Make({}, {}));
  ASSERT_NE(ratio.FindKind("odometry"), nullptr);
  EXPECT_EQ(ratio.FindKind("odometry")->candidates, 0);
  EXPECT_EQ(ratio.log_ratio, without.log_ratio);
  EXPECT_EQ(ratio.log10_nfa, without.log10_nfa);
}

// Two points that chance explains on their own, and lengths that agree.
TEST(EvidenceKind, MakesARatioMeaningfulTogetherWithFeatures) {
  testing::SyntheticTripletOptions options;
  options.num_points = 2;
  options.noise_px = 0.5;
  int alone = 0, together = 0, contradicted = 0;
  constexpr int kTriplets = 40;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const testing::SyntheticTriplet triplet =
        testing::MakeSyntheticTriplet(options, seed);
    const auto meaningful = [&](const EvidenceKinds& kinds) {
      return AContrarioScaleEstimator(kinds).Estimate(triplet.view)->verdict ==
             RatioVerdict::kMeaningful;
    };
    const auto odometry = [&](double log_ratio) {
      return std::make_shared<Odometry>(
          Odometry::Lengths{{{0, 1}, 1}, {{1, 2}, std::exp(log_ratio)}}, 0.005);
    };
    alone += meaningful(*EvidenceRegistry::BuiltIn().Make({}, {}));
    together += meaningful(With(odometry(triplet.true_log_ratio)));
    // The lengths bear out no point, and cost tests.
    contradicted += meaningful(With(odometry(triplet.true_log_ratio + 1)));
  }
  EXPECT_GT(together, alone);
  EXPECT_LE(contradicted, alone);
}

TEST(EvidenceKind, AloneIsOneCandidateThatNothingAgreesWith) {
  testing::SyntheticTriplet triplet = testing::MakeSyntheticTriplet({}, 1);
  const auto ratio =
      AContrarioScaleEstimator(
          {std::make_shared<Odometry>(
              Odometry::Lengths{{{0, 1}, 1}, {{1, 2}, 1.5}}, 0.01)})
          .Estimate(triplet.view);
  ASSERT_TRUE(ratio.has_value());
  EXPECT_EQ(ratio->verdict, RatioVerdict::kNotMeaningful);
  EXPECT_NEAR(ratio->log_ratio, std::log(1.5), 1e-12);
}

// Candidates without a ratio, or with a deviation that is none, would spoil the
// others.
TEST(Evidence, LeavesOutCandidatesThatSayNothing) {
  for (const double bad : {0.0, -1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_EQ(OdometryEvidence(0.1, bad).size(), 0) << bad;
  }
  EXPECT_EQ(OdometryEvidence(std::nan(""), 0.1).size(), 0);
  EXPECT_EQ(OdometryEvidence(HUGE_VAL, 0.1).size(), 0);
  EXPECT_EQ(OdometryEvidence(0.1, 0.1).size(), 1);
}

TEST(Evidence, BoundsByDefaultHoldErrorsThatRiseFromTheirOwnRatio) {
  const OdometryEvidence evidence(0.2, 0.1);
  for (const auto& [low, high] :
       {std::pair(-0.5, 0.1), std::pair(0.1, 0.4), std::pair(0.3, 2.0)}) {
    float least = 0, most = 0;
    evidence.Bound(std::exp(low), std::exp(high), &least, &most);
    for (int n = 0; n <= 10; ++n) {
      const double tau = std::exp(low + 0.1 * n * (high - low));
      float error = 0;
      evidence.Errors(tau, 1, &error);
      EXPECT_EQ(error, evidence.ErrorOf(tau, 0));
      EXPECT_GE(error, least - 1e-5f);
      EXPECT_LE(error, most + 1e-5f);
    }
  }
}

class PairsInTwoTiers : public Evidence {
 public:
  PairsInTwoTiers() {
    StartPairs(2);
    const RatioCandidate ratio{CandidateStatus::kValid, 0.1, 0.1};
    AddPair(ratio, 0, {7, 2});
    AddPair(ratio, 0, {7, 5});
    AddPair(ratio, 1, {3, 2});
  }
  float ErrorOf(double, int) const override { return 1; }
};

TEST(Evidence, NumbersTheUnitsOfPairsAsTheyFirstOccur) {
  const PairsInTwoTiers evidence;
  const EvidenceUnits& units = evidence.units();
  EXPECT_THAT(units.of_pair[0], ::testing::ElementsAre(0, 0, 1));
  EXPECT_THAT(units.of_pair[1], ::testing::ElementsAre(0, 1, 0));
  EXPECT_EQ(units.tiers[0].num_candidates, 2);
  EXPECT_THAT(units.tiers[0].num_units, ::testing::ElementsAre(1, 2));
  EXPECT_EQ(units.tiers[1].num_candidates, 3);
  EXPECT_THAT(units.tiers[1].num_units, ::testing::ElementsAre(2, 2));
}

}  // namespace
}  // namespace lowlap
