#include "lowlap/scale/scale_estimator.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <string>
#include <vector>

#include "lowlap/geometry/internal/rotation.h"
#include "lowlap/scale/evidence/internal/coplanar_candidates.h"
#include "lowlap/scale/internal/candidate_limits.h"
#include "lowlap/scale/internal/uncertainty/ratio_inliers.h"
#include "scale/estimate.h"
#include "scale/synthetic_triplet.h"

namespace lowlap {
namespace {

using testing::EstimateRatio;
using testing::MakeSyntheticTriplet;
using testing::PairsOnly;
using testing::SwapEnds;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;

SyntheticTripletOptions Mixed(double noise_px, double wrong_share) {
  SyntheticTripletOptions options;
  options.num_points = 40;
  options.num_lines = 25;
  options.num_lines_ij = options.num_lines_jk = 50;
  options.noise_px = noise_px;
  options.wrong_share = wrong_share;
  return options;
}

double Median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + values.size() / 2,
                   values.end());
  return values[values.size() / 2];
}

struct KindCase {
  std::string name;
  std::vector<std::string> features;  // empty: all
  ScaleCriterion criterion = ScaleCriterion::kAContrario;
  NfaForm form = NfaForm::kCalibrated;
};

class EveryKind : public ::testing::TestWithParam<KindCase> {
 protected:
  static ScaleOptions Options() {
    ScaleOptions options;
    options.features = GetParam().features;
    options.criterion = GetParam().criterion;
    options.nfa_form = GetParam().form;
    return options;
  }
};

TEST_P(EveryKind, IsExactWithoutNoise) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const SyntheticTriplet triplet = MakeSyntheticTriplet(Mixed(0, 0), seed);
    const ScaleRatio ratio = EstimateRatio(triplet.view, Options());
    EXPECT_EQ(ratio.verdict, RatioVerdict::kMeaningful);
    EXPECT_NEAR(ratio.log_ratio, triplet.true_log_ratio, 1e-4);
    for (const std::string feature : {"points", "lines", "coplanar"}) {
      const KindSupport* kind = ratio.FindKind(feature);
      EXPECT_EQ(kind != nullptr && kind->candidates > 0,
                Options().Asks(feature));
    }
    if (const KindSupport* pairs = ratio.FindKind("coplanar")) {
      EXPECT_EQ(pairs->inliers,
                static_cast<int>(ratio.coplanar_inliers.size()));
    }
  }
}

TEST_P(EveryKind, SurvivesNoiseAndWrongMatches) {
  int good = 0;
  for (std::uint64_t seed = 0; seed < 20; ++seed) {
    const SyntheticTriplet triplet =
        MakeSyntheticTriplet(Mixed(0.5, 0.3), seed);
    const ScaleRatio ratio = EstimateRatio(triplet.view, Options());
    good += ratio.verdict == RatioVerdict::kMeaningful &&
            std::abs(ratio.log_ratio - triplet.true_log_ratio) < 0.03;
  }
  EXPECT_GE(good, 18);
}

TEST_P(EveryKind, NegatesTheLogRatioWhenTheEndsAreSwapped) {
  for (std::uint64_t seed = 0; seed < 5; ++seed) {
    const SyntheticTriplet triplet =
        MakeSyntheticTriplet(Mixed(0.5, 0.3), seed);
    const ScaleRatio ratio = EstimateRatio(triplet.view, Options());
    const ScaleRatio swapped = EstimateRatio(SwapEnds(triplet.view), Options());
    EXPECT_NEAR(ratio.log_ratio, -swapped.log_ratio,
                0.2 * ratio.log_ratio_stddev);
    EXPECT_NEAR(ratio.log10_nfa, swapped.log10_nfa,
                0.05 * std::abs(ratio.log10_nfa));
  }
}

INSTANTIATE_TEST_SUITE_P(
    Kinds, EveryKind,
    ::testing::Values(
        KindCase{"Points", {"points"}}, KindCase{"Lines", {"lines"}},
        KindCase{"Coplanar", {"coplanar"}}, KindCase{"All", {}},
        KindCase{"AllInTheFormOfThePaper",
                 {},
                 ScaleCriterion::kAContrario,
                 NfaForm::kPaper},
        KindCase{"AllByFixedThreshold", {}, ScaleCriterion::kFixedThreshold}),
    [](const auto& kind) { return kind.param.name; });

TEST(ScaleEstimator, ErrorGrowsInProportionToTheNoise) {
  std::vector<double> medians;
  for (const double noise_px : {0.25, 1.0}) {
    std::vector<double> errors;
    for (std::uint64_t seed = 0; seed < 60; ++seed) {
      const SyntheticTriplet triplet =
          MakeSyntheticTriplet(PairsOnly(50, noise_px, 0.1), seed);
      errors.push_back(std::abs(EstimateRatio(triplet.view).log_ratio -
                                triplet.true_log_ratio));
    }
    medians.push_back(Median(errors));
  }
  EXPECT_LT(medians[1], 0.005);
  EXPECT_GT(medians[1] / medians[0], 2);
  EXPECT_LT(medians[1] / medians[0], 8);
}

double WrongPairShare(const SyntheticTriplet& triplet) {
  const auto pairs =
      FindCoplanarCandidates(triplet.view.geometry, triplet.view.lines_ij,
                             triplet.view.lines_jk, 10)
          .pairs;
  int wrong = 0;
  for (const CoplanarPairCandidate& pair : pairs) {
    const int a = triplet.wall_ij[pair.first], b = triplet.wall_jk[pair.last];
    wrong += a < 0 || a != b;
  }
  return static_cast<double>(wrong) / static_cast<double>(pairs.size());
}

TEST(ScaleEstimator, SurvivesSeventyPercentWrongCoplanarPairs) {
  std::vector<double> errors;
  double wrong_share = 0;
  int meaningful = 0;
  constexpr int kTriplets = 40;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const SyntheticTriplet triplet =
        MakeSyntheticTriplet(PairsOnly(80, 1.0, 0.45), seed);
    wrong_share += WrongPairShare(triplet) / kTriplets;
    const ScaleRatio ratio = EstimateRatio(triplet.view);
    meaningful += ratio.verdict == RatioVerdict::kMeaningful;
    errors.push_back(std::abs(ratio.log_ratio - triplet.true_log_ratio));
  }
  EXPECT_GE(wrong_share, 0.7);
  EXPECT_GE(meaningful, kTriplets * 8 / 10);
  EXPECT_LT(Median(errors), 0.01);
  EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 0.1);
}

TEST(ScaleEstimator, StatedDeviationsHoldTheTruth) {
  for (const bool pose_errors : {false, true}) {
    SyntheticTripletOptions options = Mixed(0.7, 0.2);
    if (pose_errors) {
      options.rotation_error_deg = 0.05;
      options.direction_error_deg = 0.2;
    }
    int inside = 0;
    std::vector<double> normalized;
    constexpr int kTriplets = 150;
    for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
      const SyntheticTriplet triplet = MakeSyntheticTriplet(options, seed);
      const ScaleRatio ratio = EstimateRatio(triplet.view);
      normalized.push_back(std::abs(ratio.log_ratio - triplet.true_log_ratio) /
                           ratio.log_ratio_stddev);
      inside += normalized.back() < 1.96;
    }
    EXPECT_GE(inside, kTriplets * 85 / 100) << pose_errors;
    EXPECT_GT(Median(normalized), 0.3) << pose_errors;
    EXPECT_LT(Median(normalized), 1.0) << pose_errors;
  }
}

TEST(ScaleEstimator, TheOrderOfTheFeaturesChangesNothing) {
  SyntheticTriplet triplet = MakeSyntheticTriplet(Mixed(0.5, 0.3), 3);
  const ScaleRatio before = EstimateRatio(triplet.view);
  TripletView& view = triplet.view;
  std::reverse(view.points.begin(), view.points.end());
  std::reverse(view.lines.begin(), view.lines.end());
  std::reverse(view.lines_ij.begin(), view.lines_ij.end());
  std::reverse(view.lines_jk.begin(), view.lines_jk.end());
  const ScaleRatio after = EstimateRatio(view);
  EXPECT_NEAR(before.log_ratio, after.log_ratio, 1e-9);
  EXPECT_NEAR(before.log_ratio_stddev, after.log_ratio_stddev, 1e-9);
  EXPECT_NEAR(before.log10_nfa, after.log10_nfa, 1e-9);
  // A sum in another order.
  ASSERT_EQ(before.kinds.size(), after.kinds.size());
  for (std::size_t n = 0; n < before.kinds.size(); ++n) {
    EXPECT_NEAR(before.kinds[n].information_share,
                after.kinds[n].information_share, 1e-9);
    EXPECT_EQ(before.kinds[n].inliers, after.kinds[n].inliers);
    EXPECT_EQ(before.kinds[n].candidates, after.kinds[n].candidates);
  }
}

TEST(ScaleEstimator, NothingToGoByIsAVerdict) {
  const SyntheticTriplet triplet = MakeSyntheticTriplet({}, 1);
  for (const ScaleCriterion criterion :
       {ScaleCriterion::kAContrario, ScaleCriterion::kFixedThreshold}) {
    ScaleOptions options;
    options.criterion = criterion;
    EXPECT_EQ(EstimateRatio(triplet.view, options).verdict,
              RatioVerdict::kNoCandidates);
  }
}

TEST(ScaleEstimator, ReversedDirectionsAreRejectedAndCounted) {
  SyntheticTriplet triplet = MakeSyntheticTriplet(Mixed(0, 0), 2);
  TripletView& view = triplet.view;
  view.geometry.cami_from_camj.translation *= -1;
  const ScaleRatio ratio = EstimateRatio(view);
  EXPECT_EQ(ratio.verdict, RatioVerdict::kNoCandidates);
  EXPECT_GE(ratio.num_rejected_negative, 100);
}

TEST(ScaleEstimator, BadInputIsAnError) {
  const SyntheticTriplet triplet = MakeSyntheticTriplet(Mixed(0, 0), 2);
  const auto error_of = [](const TripletView& view) {
    const Result<ScaleRatio> ratio =
        MakeScaleEstimator(ScaleOptions())->Estimate(view);
    return ratio ? std::string() : ratio.error().message;
  };
  TripletView view = triplet.view;
  view.geometry.camk_from_camj.translation *= 2;
  EXPECT_THAT(error_of(view), ::testing::HasSubstr("unit direction"));
  view = triplet.view;
  view.geometry.cami_from_camj.rotation(0, 0) = std::nan("");
  EXPECT_THAT(error_of(view), ::testing::HasSubstr("rotation"));
  // What three times the tolerance of a scene allows is an inverse's rounding.
  view = triplet.view;
  view.geometry.camk_from_camj.translation *= 1 + 2.9 * kUnitTolerance;
  EXPECT_EQ(error_of(view), "");
  view.geometry.camk_from_camj.translation *= 1 + 0.2 * kUnitTolerance;
  EXPECT_THAT(error_of(view), ::testing::HasSubstr("unit direction"));
  view = triplet.view;
  view.geometry.focal_j_px = 0;
  EXPECT_THAT(error_of(view), ::testing::HasSubstr("focal"));
}

TEST(ScaleOptions, AreValidated) {
  EXPECT_TRUE(ScaleOptions().Validate());
  ScaleOptions options;
  options.features = {"points", "colours"};
  EXPECT_FALSE(options.Validate());
  options = {};
  options.without = {"colours"};
  EXPECT_FALSE(options.Validate());
  options = {};
  options.features = options.without = {"points"};
  EXPECT_FALSE(options.Validate());
  options = {};
  options.threshold_px = 0;
  EXPECT_FALSE(options.Validate());
}

// Such a ratio is written to scenes, which hold finite numbers only.
TEST(ScaleEstimator, ARatioThatNoFeatureBearsOutHasAFiniteDeviation) {
  const SyntheticTriplet triplet = MakeSyntheticTriplet({}, 1);
  const TripletEvidence evidence = testing::Gather(triplet.view);
  const RatioSupport support(evidence);
  ScaleRatio ratio = EmptyRatio(triplet.view, evidence);
  RefineOnInliers(triplet.view, support, {}, 0.5, &ratio);
  EXPECT_EQ(ratio.log_ratio, 0.5);
  EXPECT_EQ(ratio.log_ratio_stddev, kMaxLogRatioStddev);
}

}  // namespace
}  // namespace lowlap
