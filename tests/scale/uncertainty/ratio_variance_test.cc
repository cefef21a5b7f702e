#include "lowlap/scale/internal/uncertainty/ratio_variance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace lowlap {
namespace {

struct Sample {
  std::vector<RatioFeature> features;
  std::vector<RatioGroup> groups;
  RatioMixture mixture;

  // Features that err by one deviation, to both sides in turn, each in a cell
  // of its own.
  void AddGroup(int count, double stddev) {
    const int group = static_cast<int>(groups.size());
    groups.push_back({count, count * stddev, 1, 2});
    mixture.noise2.push_back(1);
    mixture.degrees.push_back(count);
    for (int n = 0; n < count; ++n) {
      RatioFeature feature;
      feature.log_ratio = n % 2 == 0 ? stddev : -stddev;
      feature.log_ratio_stddev = stddev;
      feature.group = group;
      feature.cell = static_cast<int>(features.size());
      features.push_back(feature);
      mixture.probability.push_back(1);
      mixture.weight.push_back(1 / (stddev * stddev));
      mixture.multiplicity.push_back(1);
    }
  }
  RatioVariance Find() const {
    return FindRatioVariance(features, groups, mixture);
  }
};

TEST(RatioVariance, OfManySureFeaturesIsThatOfTheirMean) {
  Sample sample;
  sample.AddGroup(10000, 0.02);
  const RatioVariance variance = sample.Find();
  EXPECT_NEAR(variance.stddev, 0.02 / std::sqrt(10000), 0.02 * 0.0002);
  EXPECT_NEAR(variance.information_share[0], 1, 1e-12);
}

TEST(RatioVariance, SharesTheInformationByPrecision) {
  Sample sample;
  sample.AddGroup(4000, 0.02);
  sample.AddGroup(1000, 0.01);
  const RatioVariance variance = sample.Find();
  EXPECT_NEAR(variance.information_share[0], 0.5, 0.01);
  EXPECT_NEAR(variance.information_share[1], 0.5, 0.01);
  const double information = 4000 / (0.02 * 0.02) + 1000 / (0.01 * 0.01);
  EXPECT_NEAR(variance.stddev * std::sqrt(information), 1, 0.02);
}

TEST(RatioVariance, GrowsInProportionToAllDeviations) {
  Sample sample, wide;
  sample.AddGroup(12, 0.02);
  wide.AddGroup(12, 0.06);
  EXPECT_NEAR(wide.Find().stddev, 3 * sample.Find().stddev, 1e-9);
}

// Few: Student's t is wider than the normal distribution.
TEST(RatioVariance, IsWiderForFewFeatures) {
  double before = 0;
  for (const int count : {1000, 100, 20, 6}) {
    Sample sample;
    sample.AddGroup(count, 0.02);
    const double inflation = sample.Find().stddev * std::sqrt(count) / 0.02;
    EXPECT_GT(inflation, before) << count;
    before = inflation;
  }
}

// The noise of a cell is the same for all of it.
TEST(RatioVariance, IsWiderIfNeighboursErrTogether) {
  Sample sample;
  sample.AddGroup(400, 0.02);
  const double alone = sample.Find().stddev;
  for (std::size_t n = 0; n < sample.features.size(); ++n) {
    // Twenty of either side to a cell.
    sample.features[n].cell = static_cast<int>(n % 2 + 2 * (n / 40));
  }
  const double together = sample.Find().stddev;
  EXPECT_GT(together, 2 * alone);
  EXPECT_LT(together, std::sqrt(20.0) * alone * 1.2);
}

}  // namespace
}  // namespace lowlap
