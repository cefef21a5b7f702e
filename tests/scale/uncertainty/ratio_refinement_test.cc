#include "lowlap/scale/internal/uncertainty/ratio_refinement.h"

#include <gmock/gmock.h>

#include <cmath>
#include <vector>

#include "lowlap/core/internal/random.h"

namespace lowlap {
namespace {

std::vector<RatioFeature> Measurements(int count, double stddev,
                                       Random* random) {
  std::vector<RatioFeature> features;
  for (int n = 0; n < count; ++n) {
    RatioFeature feature;
    feature.log_ratio_stddev = stddev;
    feature.log_ratio = 0.3 + random->Gaussian(stddev);
    feature.cell = n;
    features.push_back(feature);
  }
  return features;
}

// One group and no more than the given features.
RefinedRatio Refine(const std::vector<RatioFeature>& features, double initial) {
  RatioGroup group;
  group.count = static_cast<int>(features.size());
  for (const RatioFeature& feature : features) {
    group.sum_of_stddevs += feature.log_ratio_stddev;
  }
  std::vector<RatioFeature> near;
  for (const RatioFeature& feature : features) {
    if (std::abs(feature.log_ratio - initial) <
        kRefinementReach * feature.log_ratio_stddev) {
      near.push_back(feature);
    }
  }
  return RefineRatio(near, {group}, initial);
}

TEST(RefineRatio, WithoutFeaturesKeepsTheStart) {
  const RefinedRatio refined = RefineRatio({}, {RatioGroup()}, 0.7);
  EXPECT_EQ(refined.log_ratio, 0.7);
  EXPECT_TRUE(std::isinf(refined.log_ratio_stddev));
}

TEST(RefineRatio, PreciseFeaturesWeighMore) {
  RatioFeature precise, vague;
  precise.log_ratio = 0.1;
  precise.log_ratio_stddev = 0.01;
  vague.log_ratio = 0.12;
  vague.log_ratio_stddev = 0.1;
  const RefinedRatio refined = Refine({precise, vague}, 0.1);
  EXPECT_NEAR(refined.log_ratio, 0.1, 0.001);
}

TEST(RefineRatio, DeviationFallsWithTheRootOfTheCount) {
  Random random(1);
  const double few =
      Refine(Measurements(100, 0.02, &random), 0.3).log_ratio_stddev;
  const double many =
      Refine(Measurements(10000, 0.02, &random), 0.3).log_ratio_stddev;
  EXPECT_NEAR(few, 0.002, 0.0005);
  EXPECT_NEAR(many, 0.0002, 0.00002);
}

TEST(RefineRatio, FindsTheNoise) {
  Random random(5);
  std::vector<RatioFeature> features = Measurements(500, 0.02, &random);
  for (RatioFeature& feature : features) feature.log_ratio_stddev = 0.01;
  const RefinedRatio refined = Refine(features, 0.3);
  EXPECT_NEAR(refined.group_noise[0], 2, 0.2);
  EXPECT_NEAR(refined.log_ratio_stddev, 0.02 / std::sqrt(500.0), 0.0002);
}

TEST(RefineRatio, OutliersHardlyMoveIt) {
  Random random(2);
  std::vector<RatioFeature> features = Measurements(200, 0.01, &random);
  for (int n = 0; n < 60; ++n) features[n].log_ratio = 0.5;
  EXPECT_NEAR(Refine(features, 0.3).log_ratio, 0.3, 0.005);
}

// Wrong ones all around, most of them; the true ones are told by their density.
TEST(RefineRatio, TellsTheProbabilityOfBeingRight) {
  Random random(6);
  std::vector<RatioFeature> features = Measurements(100, 0.005, &random);
  for (int n = 0; n < 400; ++n) {
    RatioFeature wrong = features[0];
    wrong.log_ratio = 0.3 + random.Uniform(-0.5, 0.5);
    wrong.cell = 100 + n;
    features.push_back(wrong);
  }
  const RefinedRatio refined = Refine(features, 0.3);
  EXPECT_NEAR(refined.log_ratio, 0.3, 0.002);
  EXPECT_NEAR(refined.group_noise[0], 1, 0.25);
  double right = 0;
  for (const double probability : refined.probability) right += probability;
  EXPECT_NEAR(right, 100, 15);
}

// Every line of one side is paired with every line of the other: the noise of
// n lines does not become that of n^2 pairs.
TEST(RefineRatio, ALineIsOneMeasurementInHoweverManyPairs) {
  Random random(3);
  constexpr int kLines = 12;
  constexpr double kNoise = 0.01;
  double squares = 0, stated = 0;
  constexpr int kTrials = 200;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<double> first, last;
    for (int n = 0; n < kLines; ++n) first.push_back(random.Gaussian(kNoise));
    for (int n = 0; n < kLines; ++n) last.push_back(random.Gaussian(kNoise));
    std::vector<RatioFeature> features;
    for (int a = 0; a < kLines; ++a) {
      for (int b = 0; b < kLines; ++b) {
        RatioFeature pair;
        pair.log_ratio = 0.3 + first[a] - last[b];
        pair.log_ratio_stddev = std::sqrt(2.0) * kNoise;
        pair.units = {a, b};
        pair.moves = {{{kNoise, 0, 0, 0}, {-kNoise, 0, 0, 0}}};
        pair.cell = kLines * a + b;
        features.push_back(pair);
      }
    }
    const RefinedRatio refined = Refine(features, 0.3);
    squares += std::pow(refined.log_ratio - 0.3, 2) / kTrials;
    stated += refined.log_ratio_stddev / kTrials;
  }
  EXPECT_NEAR(stated / std::sqrt(squares), 1.0, 0.2);
}

// Wrong lines have few right pairs; they must not make the noise look larger.
TEST(RefineRatio, WrongPairsDoNotWidenTheNoise) {
  Random random(8);
  constexpr int kTrials = 60, kLines = 6;
  constexpr double kNoise = 0.01;
  double noise = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<RatioFeature> features;
    const auto add = [&](int first, int last, double log_ratio) {
      RatioFeature pair;
      pair.log_ratio = log_ratio;
      pair.log_ratio_stddev = std::sqrt(2.0) * kNoise;
      pair.units = {first, last};
      pair.moves = {{{kNoise, 0, 0, 0}, {-kNoise, 0, 0, 0}}};
      pair.cell = static_cast<int>(features.size());
      features.push_back(pair);
    };
    std::vector<double> first, last;
    for (int n = 0; n < kLines; ++n) first.push_back(random.Gaussian(kNoise));
    for (int n = 0; n < kLines; ++n) last.push_back(random.Gaussian(kNoise));
    for (int a = 0; a < kLines; ++a) {
      for (int b = 0; b < kLines; ++b) add(a, b, 0.3 + first[a] - last[b]);
    }
    for (int n = kLines; n < 10 * kLines; ++n) {
      add(n, n, 0.3 + random.Uniform(-0.3, 0.3));
    }
    noise += Refine(features, 0.3).group_noise[0] / kTrials;
  }
  EXPECT_GT(noise, 0.9);
  EXPECT_LT(noise, 1.4);
}

// Few right ones among wrong ones, of unknown noise.
TEST(RefineRatio, IntervalHoldsAmongWrongFeatures) {
  Random random(9);
  constexpr int kTrials = 2000;
  constexpr double kStddev = 0.02;
  int inside = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    std::vector<RatioFeature> features = Measurements(10, kStddev, &random);
    for (int n = 0; n < 15; ++n) {
      RatioFeature wrong = features[0];
      wrong.log_ratio = 0.3 + random.Uniform(-0.5, 0.5);
      wrong.cell = 10 + n;
      features.push_back(wrong);
    }
    RatioGroup group;
    group.count = static_cast<int>(features.size());
    group.sum_of_stddevs = kStddev * group.count;
    group.noise = 2;
    group.prior_count = 0.25;
    std::vector<RatioFeature> near;
    for (const RatioFeature& feature : features) {
      if (std::abs(feature.log_ratio - 0.3) <
          kRefinementReach * group.noise * kStddev) {
        near.push_back(feature);
      }
    }
    const RefinedRatio refined = RefineRatio(near, {group}, 0.3);
    inside +=
        std::abs(refined.log_ratio - 0.3) < 1.96 * refined.log_ratio_stddev;
  }
  EXPECT_GE(inside, 0.94 * kTrials);
  EXPECT_LE(inside, 0.97 * kTrials);
  RecordProperty("inside", inside);
}

TEST(RefineRatio, ErrorsSharedByACellDoNotAverageOut) {
  Random random(4);
  constexpr int kCells = 16, kPerCell = 100;
  std::vector<RatioFeature> features;
  for (int cell = 0; cell < kCells; ++cell) {
    const double shared = random.Gaussian(0.01);
    for (RatioFeature feature : Measurements(kPerCell, 0.01, &random)) {
      feature.log_ratio += shared;
      feature.cell = cell;
      features.push_back(feature);
    }
  }
  const double stddev = Refine(features, 0.3).log_ratio_stddev;
  EXPECT_GT(stddev, 0.6 * 0.01 / std::sqrt(kCells));
  EXPECT_LT(stddev, 2.0 * 0.01 / std::sqrt(kCells));
}

// Four around 0.3.
std::vector<RatioFeature> FourPoints() {
  std::vector<RatioFeature> points;
  for (const double log_ratio : {0.28, 0.29, 0.31, 0.32}) {
    RatioFeature point;
    point.log_ratio = log_ratio;
    point.log_ratio_stddev = 0.02;
    point.cell = static_cast<int>(points.size());
    points.push_back(point);
  }
  return points;
}

RatioGroup GroupOf(int count, double stddev) {
  RatioGroup group;
  group.count = count;
  group.sum_of_stddevs = count * stddev;
  return group;
}

// The only one of its group is four deviations away, and more precise than
// all others together.
TEST(RefineRatio, AGroupWithoutNearFeaturesDoesNotPull) {
  std::vector<RatioFeature> features = FourPoints();
  const RatioGroup points = GroupOf(4, 0.02);
  const RefinedRatio alone = RefineRatio(features, {points}, 0.3);
  for (const double side : {-1, 1}) {
    RatioFeature line;
    line.log_ratio = 0.3 + side * 0.02;
    line.log_ratio_stddev = 0.005;
    line.group = 1;
    line.cell = 4;
    features.resize(4);
    features.push_back(line);
    const RefinedRatio refined =
        RefineRatio(features, {points, GroupOf(1, 0.005)}, 0.3);
    EXPECT_LT(refined.probability.back(), 0.01);
    EXPECT_NEAR(refined.log_ratio, alone.log_ratio, 1e-4);
    EXPECT_NEAR(refined.log_ratio_stddev, alone.log_ratio_stddev, 1e-4);
    EXPECT_LT(refined.information_share[1], 0.01);
  }
}

TEST(RefineRatio, AGroupWithoutCandidatesChangesNothing) {
  const RatioGroup points = GroupOf(4, 0.02);
  const RefinedRatio alone = RefineRatio(FourPoints(), {points}, 0.31);
  const RefinedRatio refined =
      RefineRatio(FourPoints(), {points, RatioGroup()}, 0.31);
  EXPECT_EQ(refined.log_ratio, alone.log_ratio);
  EXPECT_EQ(refined.log_ratio_stddev, alone.log_ratio_stddev);
  EXPECT_EQ(refined.probability, alone.probability);
  EXPECT_EQ(refined.group_noise[1], 1);
  EXPECT_EQ(refined.information_share[1], 0);
}

TEST(RefineRatio, SharesOfInformationAreThoseOfTheGroups) {
  Random random(7);
  std::vector<RatioFeature> features = Measurements(100, 0.01, &random);
  for (RatioFeature feature : Measurements(100, 0.02, &random)) {
    feature.group = 1;
    feature.cell += 100;
    features.push_back(feature);
  }
  const RefinedRatio refined =
      RefineRatio(features, {GroupOf(100, 0.01), GroupOf(100, 0.02)}, 0.3);
  EXPECT_NEAR(refined.information_share[0], 0.8, 0.1);
  EXPECT_NEAR(refined.information_share[1], 0.2, 0.1);
}

}  // namespace
}  // namespace lowlap
