#include <gtest/gtest.h>

#include <cmath>
#include <map>
#include <string>

#include "scale/interval_classes.h"

namespace lowlap {
namespace {

using testing::AllIntervalClasses;
using testing::IntervalClass;
using testing::IntervalCoverage;
using testing::MakeSyntheticTriplet;
using testing::MeasureCoverage;
using testing::SyntheticTriplet;
using testing::SyntheticTripletOptions;

// All kinds or one, noise of 0.3 to 2 px, up to half of the features wrong,
// relative poses as wrong as their covariance says.
SyntheticTripletOptions RandomOptions(std::uint64_t seed) {
  Random random(seed);
  SyntheticTripletOptions options;
  const std::size_t kinds = random.Index(4);
  if (kinds != 1 && kinds != 2) {
    options.num_points = 10 + static_cast<int>(random.Index(20));
  }
  if (kinds != 0 && kinds != 2) {
    options.num_lines = 10 + static_cast<int>(random.Index(15));
  }
  if (kinds != 0 && kinds != 1) {
    options.num_lines_ij = 15 + static_cast<int>(random.Index(20));
    options.num_lines_jk = 15 + static_cast<int>(random.Index(20));
  }
  options.noise_px = random.Uniform(0.3, 2);
  options.wrong_share = random.Uniform(0, 0.5);
  const double pose_error = random.Uniform(0, 0.2);
  options.rotation_error_deg = pose_error;
  options.direction_error_deg = 5 * pose_error;
  return options;
}

TEST(RatioInterval, HoldsTheTruthAsOftenAsItSays) {
  constexpr int kTriplets = 3000;
  int meaningful = 0, inside = 0;
  for (std::uint64_t seed = 0; seed < kTriplets; ++seed) {
    const SyntheticTriplet triplet =
        MakeSyntheticTriplet(RandomOptions(seed), seed);
    const Result<ScaleRatio> ratio =
        MakeScaleEstimator({})->Estimate(triplet.view);
    ASSERT_TRUE(ratio.has_value());
    if (ratio->verdict != RatioVerdict::kMeaningful) continue;
    ++meaningful;
    inside += std::abs(ratio->log_ratio - triplet.true_log_ratio) <
              1.96 * ratio->log_ratio_stddev;
  }
  EXPECT_GE(meaningful, 2000);
  EXPECT_GE(inside, 0.93 * meaningful);
  EXPECT_LE(inside, 0.97 * meaningful);
  RecordProperty("meaningful", meaningful);
  RecordProperty("inside", inside);
}

// By kind, noise, share of wrong features and poses, one at a time; the table
// of all combinations is in interval_classes_long_test.cc.
TEST(RatioInterval, HoldsTheTruthWhateverTheClass) {
  std::map<std::string, IntervalCoverage> groups;
  std::uint64_t class_seed = 1;
  for (const IntervalClass& of : AllIntervalClasses()) {
    const IntervalCoverage coverage =
        MeasureCoverage(of, 60, 120, class_seed++);
    groups[of.Kinds()].Add(coverage);
    groups["noise of " + std::to_string(of.noise_px)].Add(coverage);
    groups["share " + std::to_string(of.wrong_share)].Add(coverage);
    groups[of.noisy_poses ? "noisy poses" : "true poses"].Add(coverage);
  }
  ASSERT_EQ(groups.size(), 12u);
  for (const auto& [name, coverage] : groups) {
    EXPECT_GE(coverage.right, 700) << name;
    EXPECT_GE(coverage.Share(), 0.93) << name;
    EXPECT_LE(coverage.Share(), 0.97) << name;
  }
}

}  // namespace
}  // namespace lowlap
