#include "lowlap/scale/internal/search/ratio_sweep.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>
#include <vector>

#include "scale/search/random_triplets.h"

namespace lowlap {
namespace {

using testing::Gather;
using testing::MakeSyntheticTriplet;
using testing::RandomOptions;
using testing::Support;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;

double ReferenceLog10Nfa(const RatioSupport& support,
                         const RatioNfaCriterion& criterion) {
  SupportWorkspace workspace;
  double least = std::numeric_limits<double>::infinity();
  for (const Hypothesis& hypothesis : support.hypotheses()) {
    const RatioNfa nfa = criterion.Evaluate(
        hypothesis.log_ratio, support.Count(hypothesis.log_ratio, &workspace));
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
        criterion.Evaluate(log_ratio, support.Count(log_ratio, &workspace));
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
    const RatioSupport support = Support(triplet.view);
    if (support.hypotheses().empty()) continue;
    const RatioNfaCriterion criterion(support, triplet.view,
                                      NfaForm::kCalibrated);
    const RatioOptimum optimum = SweepRatios(support, criterion);
    const double reference = ReferenceLog10Nfa(support, criterion);
    EXPECT_LE(optimum.nfa.log10_nfa, reference + 1e-9) << seed;
    better += optimum.nfa.log10_nfa < reference - 0.1;
    // What is returned is what holds there.
    SupportWorkspace workspace;
    EXPECT_EQ(optimum.nfa.log10_nfa,
              criterion
                  .Evaluate(optimum.log_ratio,
                            support.Count(optimum.log_ratio, &workspace))
                  .log10_nfa);
  }
  EXPECT_GE(better, kTriplets / 10);
}

// The stated tolerance: 1 % of log10 NFA, and 0.05 near 0.
TEST(RatioSweep, IsTheLeastOfADenseScan) {
  constexpr int kTriplets = 300;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const SyntheticTriplet triplet =
        MakeSyntheticTriplet(RandomOptions(7000 + seed), seed);
    const RatioSupport support = Support(triplet.view);
    if (support.hypotheses().empty()) continue;
    const RatioNfaCriterion criterion(support, triplet.view,
                                      NfaForm::kCalibrated);
    const RatioOptimum optimum = SweepRatios(support, criterion);
    const double scanned = ScannedLog10Nfa(support, criterion);
    EXPECT_LE(optimum.nfa.log10_nfa,
              scanned + std::max(0.05, 0.01 * std::abs(scanned)))
        << seed;
  }
}

// Within the same tolerance, what the sweep finds from either end of the
// triplet is the least at the ratio found from the other, too, also where many
// candidates leave the best counts to a narrow segment.
TEST(RatioSweep, FindsWhatIsFoundFromTheOtherEnd) {
  constexpr int kTriplets = 300;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    Random random(seed);
    SyntheticTripletOptions options;
    options.num_points = static_cast<int>(random.Index(80));
    options.num_lines = static_cast<int>(random.Index(50));
    options.num_lines_ij = static_cast<int>(random.Index(60));
    options.num_lines_jk = static_cast<int>(random.Index(60));
    options.noise_px = random.Uniform(0.2, 2);
    options.wrong_share = random.Uniform(0, 0.6);
    const TripletView view = MakeSyntheticTriplet(options, 900 + seed).view;
    const TripletView swapped = testing::SwapEnds(view);
    const RatioSupport supports[2] = {Support(view), Support(swapped)};
    if (supports[0].hypotheses().empty()) continue;
    const RatioNfaCriterion criteria[2] = {
        {supports[0], view, NfaForm::kCalibrated},
        {supports[1], swapped, NfaForm::kCalibrated}};
    for (const int end : {0, 1}) {
      const RatioOptimum optimum = SweepRatios(supports[end], criteria[end]);
      const double elsewhere =
          -SweepRatios(supports[1 - end], criteria[1 - end]).log_ratio;
      SupportWorkspace workspace;
      const double there =
          criteria[end]
              .Evaluate(elsewhere, supports[end].Count(elsewhere, &workspace))
              .log10_nfa;
      EXPECT_LE(optimum.nfa.log10_nfa,
                there + std::max(0.05, 0.01 * std::abs(there)))
          << seed;
    }
  }
}

TEST(RatioSweep, OneHypothesisIsItsOwnOptimum) {
  SyntheticTripletOptions options;
  options.num_points = 1;
  const SyntheticTriplet triplet = MakeSyntheticTriplet(options, 1);
  const RatioSupport support(Gather(triplet.view));
  const RatioNfaCriterion criterion(support, triplet.view,
                                    NfaForm::kCalibrated);
  EXPECT_EQ(SweepRatios(support, criterion).log_ratio,
            support.hypotheses().front().log_ratio);
}

}  // namespace
}  // namespace lowlap
