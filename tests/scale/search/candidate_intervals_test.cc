#include "lowlap/scale/internal/search/candidate_intervals.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "lowlap/core/internal/random.h"
#include "scale/search/random_triplets.h"

namespace lowlap {
namespace {

using testing::MakeSyntheticTriplet;
using testing::RandomOptions;
using testing::Support;
using testing::SyntheticTriplet;

TEST(Evidence, BoundsHoldEveryErrorInTheWindow) {
  Random random(3);
  for (std::uint64_t seed = 0; seed < 60; ++seed) {
    const SyntheticTriplet triplet =
        MakeSyntheticTriplet(RandomOptions(seed), seed);
    const RatioSupport support = Support(triplet.view);
    const double middle = triplet.true_log_ratio + random.Uniform(-1, 1);
    const double half_width = std::pow(10.0, random.Uniform(-4, 0.3));
    KindErrors least_px, most_px;
    support.Bound(middle - half_width, middle + half_width, &least_px,
                  &most_px);
    std::vector<float> errors_px;
    for (int n = 0; n <= 40; ++n) {
      const double log_ratio = middle + half_width * (n / 20.0 - 1);
      for (int k = 0; k < support.num_kinds(); ++k) {
        const Evidence& kind = support.kind(k);
        errors_px.resize(kind.size());
        kind.Errors(std::exp(log_ratio), kind.size(), errors_px.data());
        for (std::size_t f = 0; f < errors_px.size(); ++f) {
          // What is huge or not finite is behind a camera.
          if (!(errors_px[f] < 1e4f)) continue;
          EXPECT_NEAR(errors_px[f],
                      kind.ErrorOf(std::exp(log_ratio), static_cast<int>(f)),
                      1e-4 + 1e-5 * errors_px[f]);
          EXPECT_LE(least_px[k][f], errors_px[f]) << seed << " " << k;
          EXPECT_GE(most_px[k][f], errors_px[f]) << seed << " " << k;
        }
      }
    }
  }
}

TEST(VisitInlierIntervals, AreWhereErrorsAreBelowTheThreshold) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    const SyntheticTriplet triplet =
        MakeSyntheticTriplet(RandomOptions(seed), seed);
    const RatioSupport support = Support(triplet.view);
    const double low = triplet.true_log_ratio - 0.8;
    const double high = triplet.true_log_ratio + 0.8;
    for (int k = 0; k < support.num_kinds(); ++k) {
      const Evidence& kind = support.kind(k);
      for (int index = 0; index < kind.size(); ++index) {
        const int step = static_cast<int>((seed + index) % kNumThresholds);
        std::vector<std::pair<double, double>> intervals;
        VisitInlierIntervals(
            kind, index, low, high, step, step + 1, [](int) { return true; },
            [&](int, double begin, double end) {
              intervals.emplace_back(begin, end);
            });
        constexpr int kNodes = 100;
        const double threshold_px = LadderThresholdPx(step);
        for (int n = 0; n <= kNodes; ++n) {
          const double log_ratio = low + (high - low) * n / kNodes;
          const double error_px = kind.ErrorOf(std::exp(log_ratio), index);
          if (std::abs(error_px - threshold_px) < 1e-3 * threshold_px) continue;
          const bool inside = std::any_of(
              intervals.begin(), intervals.end(), [&](const auto& interval) {
                return log_ratio >= interval.first &&
                       log_ratio <= interval.second;
              });
          EXPECT_EQ(inside, error_px < threshold_px)
              << seed << " kind " << k << " " << error_px;
        }
      }
    }
  }
}

}  // namespace
}  // namespace lowlap
