#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "lowlap/scale/evidence/internal/line_in_middle.h"
#include "lowlap/scale/scale_estimator.h"
#include "scale/estimate.h"
#include "scale/even_evidence.h"
#include "scale/synthetic_room.h"
#include "scale/synthetic_triplet.h"

namespace lowlap {
namespace {

using testing::EstimateRatio;
using testing::Even;
using testing::EvidenceOf;
using testing::MakeSyntheticTriplet;
using testing::PairsOnly;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;
using testing::ValidTriplet;

ScaleRatio Judge(const TripletEvidence& evidence,
                 NfaForm form = NfaForm::kCalibrated,
                 RatioSearch search = RatioSearch::kSweep) {
  const auto ratio = AContrarioScaleEstimator({}, form, search)
                         .Estimate(ValidTriplet(), evidence);
  EXPECT_TRUE(ratio.has_value()) << ratio.error().ToString();
  return *ratio;
}

// Eight that agree on 0.5, six on 2, and some that agree on nothing.
const std::vector<double> kTwoModes = {0.5,   0.503, 0.498, 0.5,   0.501, 0.497,
                                       0.502, 0.499, 2.001, 1.998, 2.002, 2,
                                       1.999, 2.003, -3,    -1.4,  3.7};

TEST(AContrarioScaleEstimator, FindsWhatMostAgreeOnAndTheSecondMode) {
  const ScaleRatio ratio = Judge(EvidenceOf({Even(kTwoModes, 0.01)}));
  EXPECT_EQ(ratio.verdict, RatioVerdict::kMeaningful);
  EXPECT_LT(ratio.log10_nfa, 0);
  // The mean of the eight, whose deviations are equal.
  EXPECT_NEAR(ratio.log_ratio, 0.5, 1e-3);
  EXPECT_EQ(ratio.kinds[0].candidates, 17);
  EXPECT_EQ(ratio.kinds[0].inliers, 8);
  ASSERT_TRUE(ratio.second_mode.has_value());
  EXPECT_NEAR(ratio.second_mode->log_ratio, 2, 0.01);
  EXPECT_GT(ratio.second_mode->log10_nfa, ratio.log10_nfa);
}

TEST(AContrarioScaleEstimator, MovesWithTheRatiosAndNotWithTheirOrder) {
  const ScaleRatio ratio = Judge(EvidenceOf({Even(kTwoModes, 0.01)}));
  std::vector<double> moved = kTwoModes;
  for (double& log_ratio : moved) log_ratio += 0.75;
  std::reverse(moved.begin(), moved.end());
  const ScaleRatio other = Judge(EvidenceOf({Even(moved, 0.01)}));
  // Errors are floats.
  EXPECT_NEAR(other.log_ratio, ratio.log_ratio + 0.75, 1e-5);
  EXPECT_NEAR(other.log_ratio_stddev, ratio.log_ratio_stddev, 1e-5);
  EXPECT_NEAR(other.log10_nfa, ratio.log10_nfa, 1e-6);
  EXPECT_EQ(other.kinds[0].inliers, ratio.kinds[0].inliers);
}

TEST(AContrarioScaleEstimator, NoRatioOfACandidateBeatsTheSweep) {
  const TripletEvidence evidence =
      EvidenceOf({Even(kTwoModes, 0.01), Even({0.48, 0.53, -2}, 0.05)});
  const double sweep = Judge(evidence).log10_nfa;
  for (const RatioSearch search :
       {RatioSearch::kFeatures, RatioSearch::kExhaustive}) {
    const ScaleRatio ratio = Judge(evidence, NfaForm::kCalibrated, search);
    EXPECT_LE(sweep, ratio.log10_nfa + 1e-9);
    EXPECT_NEAR(ratio.log_ratio, 0.5, 1e-3);
  }
}

TEST(AContrarioScaleEstimator, AKindThatSaysNothingHasNoInliers) {
  const ScaleRatio ratio =
      Judge(EvidenceOf({Even(kTwoModes, 0.01), Even({-3, 3}, 0.5), nullptr}));
  EXPECT_EQ(ratio.verdict, RatioVerdict::kMeaningful);
  EXPECT_EQ(ratio.kinds[0].inliers, 8);
  EXPECT_EQ(ratio.kinds[1].candidates, 2);
  EXPECT_EQ(ratio.kinds[1].inliers, 0);
  EXPECT_EQ(ratio.kinds[1].information_share, 0);
  EXPECT_EQ(ratio.kinds[2].candidates, 0);
}

// Tests that find more false ratios cost their logarithm; enough of them, and
// nothing is meaningful.
TEST(AContrarioScaleEstimator, PaysForEveryTest) {
  TripletEvidence evidence = EvidenceOf({Even(kTwoModes, 0.01)});
  const ScaleRatio once = Judge(evidence);
  evidence.num_tests = 2;
  const ScaleRatio twice = Judge(evidence);
  EXPECT_DOUBLE_EQ(twice.log10_nfa, once.log10_nfa + std::log10(2));
  EXPECT_DOUBLE_EQ(twice.second_mode->log10_nfa,
                   once.second_mode->log10_nfa + std::log10(2));
  EXPECT_EQ(twice.verdict, RatioVerdict::kMeaningful);
  EXPECT_EQ(twice.log_ratio, once.log_ratio);

  // Three that agree: an NFA that an int can outweigh.
  evidence = EvidenceOf({Even({0.5, 0.5, 0.5}, 0.1)});
  const double alone = Judge(evidence).log10_nfa;
  ASSERT_LT(alone, 0);
  ASSERT_GT(alone, -9);
  evidence.num_tests = static_cast<int>(std::pow(10, -alone) * 0.99);
  EXPECT_EQ(Judge(evidence).verdict, RatioVerdict::kMeaningful);
  evidence.num_tests = static_cast<int>(std::pow(10, -alone) * 1.01) + 1;
  EXPECT_EQ(Judge(evidence).verdict, RatioVerdict::kNotMeaningful);
}

TEST(AContrarioScaleEstimator, TellsNoCandidatesFromChance) {
  EXPECT_EQ(Judge({}).verdict, RatioVerdict::kNoCandidates);
  EXPECT_EQ(Judge(EvidenceOf({nullptr, Even({}, 1)})).verdict,
            RatioVerdict::kNoCandidates);
  const ScaleRatio chance = Judge(EvidenceOf({Even({-2, 0.25, 3}, 0.01)}));
  EXPECT_EQ(chance.verdict, RatioVerdict::kNotMeaningful);
  EXPECT_GE(chance.log10_nfa, 0);
  EXPECT_FALSE(chance.second_mode.has_value());
}

// Even evidence has no term in the form of the paper.
TEST(AContrarioScaleEstimator, JudgesByItsForm) {
  const ScaleRatio ratio =
      Judge(EvidenceOf({Even(kTwoModes, 0.01)}), NfaForm::kPaper);
  EXPECT_EQ(ratio.verdict, RatioVerdict::kNotMeaningful);
  EXPECT_FALSE(ratio.second_mode.has_value());
}

// The promise: on features that have nothing in common, at most one ratio in a
// hundred is called meaningful.
class PureNoise : public ::testing::TestWithParam<
                      std::pair<const char*, std::vector<int>>> {};

TEST_P(PureNoise, IsMeaningfulAtMostOnceInAHundredTriplets) {
  const std::vector<int>& counts = GetParam().second;
  SyntheticTripletOptions options;
  options.pure_noise = true;
  options.noise_px = 1;
  options.num_points = counts[0];
  options.num_lines = counts[1];
  options.num_lines_ij = options.num_lines_jk = counts[2];
  constexpr int kTriplets = 2000;
  int meaningful = 0;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 5000 + seed);
    meaningful +=
        EstimateRatio(triplet.view).verdict == RatioVerdict::kMeaningful;
  }
  EXPECT_LE(meaningful, kTriplets / 100);
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, PureNoise,
    ::testing::Values(std::make_pair("Points", std::vector<int>{40, 0, 0}),
                      std::make_pair("FewPoints", std::vector<int>{8, 0, 0}),
                      std::make_pair("Lines", std::vector<int>{0, 30, 0}),
                      std::make_pair("Pairs", std::vector<int>{0, 0, 40}),
                      std::make_pair("FewPairs", std::vector<int>{0, 0, 12}),
                      std::make_pair("ManyPairs", std::vector<int>{0, 0, 80}),
                      std::make_pair("Mixed", std::vector<int>{20, 15, 30})),
    [](const auto& kind) { return kind.param.first; });

// Lines of walls in one pair; in the other each at a depth of its own, parallel
// to itself, as a match of the next of several edges puts it. All lines beside
// it on the same wall agree with it on a ratio, which is no more than its own.
TEST(AContrarioScaleEstimator, ABundleThatMeetsOneLineIsNotMeaningful) {
  constexpr int kTriplets = 300;
  int meaningful = 0;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    Random random(seed);
    TripletView view =
        MakeSyntheticTriplet(PairsOnly(80, 0.3, 0), 70000 + seed).view;
    const RigidTransform& camk = view.geometry.camk_from_camj;
    for (MatchedLine& line : view.lines_jk) {
      const double factor = std::exp(random.Gaussian(0.5));
      NormalizedSegment& in_k = line.in_neighbor.segment;
      const auto image = [&](const Vec3& x) {
        return camk * Vec3(factor * DepthOnPlane(camk, in_k.normal, x) * x);
      };
      const NormalizedSegment& in_j = line.in_middle.segment;
      in_k = testing::MakeSegment(image(in_j.start), image(in_j.end));
    }
    meaningful += EstimateRatio(view).verdict == RatioVerdict::kMeaningful;
  }
  EXPECT_LE(meaningful, kTriplets / 100);
}

TEST(AContrarioScaleEstimator, ThePaperFormTakesNoiseForACertainty) {
  SyntheticTripletOptions options = PairsOnly(60, 1.0, 0);
  options.pure_noise = true;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 1);
  ScaleOptions paper;
  paper.nfa_form = NfaForm::kPaper;
  EXPECT_LT(EstimateRatio(triplet.view, paper).log10_nfa, -80);
  EXPECT_EQ(EstimateRatio(triplet.view).verdict, RatioVerdict::kNotMeaningful);
}

// Large triplets try a subset; it must be as good as trying all.
TEST(AContrarioScaleEstimator, TheSubsetFindsWhatTheExhaustiveSearchFinds) {
  for (std::uint64_t seed = 0; seed < 8; ++seed) {
    SyntheticTripletOptions options = PairsOnly(80, 1.0, 0.3);
    options.num_points = 250;
    const SyntheticTriplet triplet = MakeSyntheticTriplet(options, seed);
    ScaleOptions exhaustive;
    exhaustive.search = RatioSearch::kExhaustive;
    const ScaleRatio reference = EstimateRatio(triplet.view, exhaustive);
    ScaleOptions subset;
    subset.search = RatioSearch::kFeatures;
    const ScaleRatio ratio = EstimateRatio(triplet.view, subset);
    EXPECT_LE(reference.log10_nfa, ratio.log10_nfa + 1e-9);
    EXPECT_LT(ratio.log10_nfa, 0.95 * reference.log10_nfa);
    EXPECT_NEAR(ratio.log_ratio, reference.log_ratio,
                reference.log_ratio_stddev);
  }
}

TEST(AContrarioScaleEstimator, OneFeatureIsNotMeaningful) {
  SyntheticTripletOptions options;
  options.num_points = 1;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 1);
  const ScaleRatio ratio = EstimateRatio(triplet.view);
  EXPECT_EQ(ratio.verdict, RatioVerdict::kNotMeaningful);
  EXPECT_NEAR(ratio.log_ratio, triplet.true_log_ratio, 1e-6);
}

}  // namespace
}  // namespace lowlap
