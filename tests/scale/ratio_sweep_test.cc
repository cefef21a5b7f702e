#include "lowlap/scale/internal/search/ratio_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "lowlap/core/random.h"
#include "lowlap/scale/internal/search/feature_intervals.h"
#include "scale/synthetic_triplet.h"

namespace lowlap {
namespace {

using testing::MakeSyntheticTriplet;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;

// Anything from three features to some forty of each kind.
SyntheticTripletOptions RandomOptions(std::uint64_t seed) {
  Random random(seed);
  SyntheticTripletOptions options;
  const int largest = random.Index(10) == 0 ? 40 : 12;
  options.num_points = static_cast<int>(random.Index(largest));
  options.num_lines = static_cast<int>(random.Index(largest));
  options.num_lines_ij = static_cast<int>(random.Index(largest + 4));
  options.num_lines_jk = static_cast<int>(random.Index(largest + 4));
  options.noise_px = random.Uniform(0, 2);
  options.wrong_share = random.Uniform(0, 0.9);
  options.pure_noise = random.Index(5) == 0;
  if (random.Index(2) == 0) {
    options.rotation_error_deg = 0.1;
    options.direction_error_deg = 0.5;
  }
  return options;
}

ScaleOptions RandomScaleOptions(std::uint64_t seed) {
  ScaleOptions options;
  if (seed % 4 == 0) options.coplanar_residual = CoplanarResidual::kPlane;
  return options;
}

double ReferenceLog10Nfa(const RatioSupport& support,
                         const RatioNfaCriterion& criterion) {
  SupportWorkspace workspace;
  double least = std::numeric_limits<double>::infinity();
  for (const Hypothesis& hypothesis : support.hypotheses()) {
    const RatioNfa nfa = criterion.Evaluate(
        hypothesis, support.Count(hypothesis.log_ratio, &workspace));
    least = std::min(least, nfa.log10_nfa);
  }
  return least;
}

double ScannedLog10Nfa(const RatioSupport& support,
                       const RatioNfaCriterion& criterion) {
  constexpr int kNodes = 4000;
  const double low = support.hypotheses().front().log_ratio;
  const double high = support.hypotheses().back().log_ratio;
  SupportWorkspace workspace;
  double least = std::numeric_limits<double>::infinity();
  for (int n = 0; n <= kNodes; ++n) {
    const double log_ratio = low + (high - low) * n / kNodes;
    const RatioNfa nfa =
        criterion.EvaluateAt(log_ratio, support.Count(log_ratio, &workspace));
    least = std::min(least, nfa.log10_nfa);
  }
  return least;
}

TEST(RatioSweep, IsNeverWorseThanTheRatioOfAnyFeature) {
  constexpr int kTriplets = 3000;
  int better = 0;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const SyntheticTriplet triplet =
        MakeSyntheticTriplet(RandomOptions(seed), seed);
    const ScaleOptions options = RandomScaleOptions(seed);
    const RatioSupport support(triplet.view, options);
    if (support.hypotheses().empty()) continue;
    const RatioNfaCriterion criterion(support, triplet.view, options);
    const RatioOptimum optimum = SweepRatios(support, criterion);
    const double reference = ReferenceLog10Nfa(support, criterion);
    EXPECT_LE(optimum.nfa.log10_nfa, reference + 1e-9) << seed;
    better += optimum.nfa.log10_nfa < reference - 0.1;
    // What is returned is what holds there.
    SupportWorkspace workspace;
    EXPECT_EQ(optimum.nfa.log10_nfa,
              criterion
                  .EvaluateAt(optimum.log_ratio,
                              support.Count(optimum.log_ratio, &workspace))
                  .log10_nfa);
  }
  EXPECT_GE(better, kTriplets / 10);
}

// The stated tolerance: 1 % of log10 NFA (and 0.02 near 0; 0.05 for the
// residual in the middle view, whose turns are approximate).
TEST(RatioSweep, IsTheLeastOfADenseScan) {
  constexpr int kTriplets = 300;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const SyntheticTriplet triplet =
        MakeSyntheticTriplet(RandomOptions(7000 + seed), seed);
    const ScaleOptions options = RandomScaleOptions(seed);
    const RatioSupport support(triplet.view, options);
    if (support.hypotheses().empty()) continue;
    const RatioNfaCriterion criterion(support, triplet.view, options);
    const RatioOptimum optimum = SweepRatios(support, criterion);
    const double scanned = ScannedLog10Nfa(support, criterion);
    const double near_0 =
        options.coplanar_residual == CoplanarResidual::kPlane ? 0.05 : 0.02;
    EXPECT_LE(optimum.nfa.log10_nfa,
              scanned + std::max(near_0, 0.01 * std::abs(scanned)))
        << seed;
  }
}

TEST(RatioSweep, BoundsHoldEveryErrorInTheWindow) {
  Random random(3);
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const SyntheticTriplet triplet =
        MakeSyntheticTriplet(RandomOptions(seed), seed);
    const RatioSupport support(triplet.view, RandomScaleOptions(seed));
    const double middle = triplet.true_log_ratio + random.Uniform(-1, 1);
    const double half_width = std::pow(10.0, random.Uniform(-4, 0.3));
    KindErrors least_px, most_px;
    support.Bound(middle - half_width, middle + half_width, &least_px,
                  &most_px);
    std::vector<float> errors_px;
    for (int n = 0; n <= 40; ++n) {
      const double log_ratio = middle + half_width * (n / 20.0 - 1);
      for (const FeatureKind kind : kFeatureKinds) {
        const std::size_t k = static_cast<std::size_t>(kind);
        support.Errors(kind, log_ratio, &errors_px);
        for (std::size_t f = 0; f < errors_px.size(); ++f) {
          // What is huge or not finite is behind a camera.
          if (!(errors_px[f] < 1e4f)) continue;
          EXPECT_NEAR(
              errors_px[f],
              support.ErrorOf(kind, static_cast<int>(f), std::exp(log_ratio)),
              1e-4 + 1e-5 * errors_px[f]);
          EXPECT_LE(least_px[k][f], errors_px[f]) << seed << " " << k;
          EXPECT_GE(most_px[k][f], errors_px[f]) << seed << " " << k;
        }
      }
    }
  }
}

TEST(RatioSweep, InlierIntervalsAreWhereErrorsAreBelowTheThreshold) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const SyntheticTriplet triplet =
        MakeSyntheticTriplet(RandomOptions(seed), seed);
    const RatioSupport support(triplet.view, RandomScaleOptions(seed));
    const double low = triplet.true_log_ratio - 0.8;
    const double high = triplet.true_log_ratio + 0.8;
    for (const FeatureKind kind : kFeatureKinds) {
      for (std::size_t f = 0; f < support.Ratios(kind).size(); ++f) {
        const int index = static_cast<int>(f);
        const int step = static_cast<int>((seed + f) % kNumThresholds);
        std::vector<std::pair<double, double>> intervals;
        VisitInlierIntervals(
            support, kind, index, low, high, step, step + 1,
            [](int) { return true; },
            [&](int, double begin, double end) {
              intervals.emplace_back(begin, end);
            });
        constexpr int kNodes = 100;
        const double threshold_px = LadderThresholdPx(step);
        for (int n = 0; n <= kNodes; ++n) {
          const double log_ratio = low + (high - low) * n / kNodes;
          const double error_px =
              support.ErrorOf(kind, index, std::exp(log_ratio));
          if (std::abs(error_px - threshold_px) < 1e-3 * threshold_px) continue;
          const bool inside = std::any_of(
              intervals.begin(), intervals.end(), [&](const auto& interval) {
                return log_ratio >= interval.first &&
                       log_ratio <= interval.second;
              });
          EXPECT_EQ(inside, error_px < threshold_px)
              << seed << " kind " << static_cast<int>(kind) << " " << error_px;
        }
      }
    }
  }
}

TEST(RatioSweep, OneHypothesisIsItsOwnOptimum) {
  SyntheticTripletOptions options;
  options.num_points = 1;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 1);
  const RatioSupport support(triplet.view, {});
  const RatioNfaCriterion criterion(support, triplet.view, {});
  EXPECT_EQ(SweepRatios(support, criterion).log_ratio,
            support.hypotheses().front().log_ratio);
}

}  // namespace
}  // namespace lowlap
