#include "lowlap/evaluation/internal/relative_errors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "evaluation/random_poses.h"

namespace lowlap {
namespace {

/// The relative pose of two solved views, from their translations.
TEST(EvaluateRelativePoses, TheTruthHasNoError) {
  Scene scene = RandomScene(5, 1);
  for (const ViewPair pair : {ViewPair{0, 2}, ViewPair{0, 8}, ViewPair{4, 6}}) {
    scene.relative_poses[pair] =
        TrueRelativePose(scene, pair.first, pair.second);
  }
  const auto result = EvaluateRelativePoses(scene, GroundTruthFromScene(scene));
  ASSERT_EQ(result.pairs.size(), 3u);
  EXPECT_EQ(result.rotation_deg.count, 3);
  EXPECT_LT(result.rotation_deg.max, 1e-10);
  EXPECT_LT(result.direction_deg.max, 1e-10);
  EXPECT_EQ(result.num_without_truth, 0);
}

TEST(EvaluateRelativePoses, ErrorsAreThoseThatWereMade) {
  Scene scene = RandomScene(5, 2);
  RelativePose turned = TrueRelativePose(scene, 0, 2);
  turned.rotation =
      RotationFromAngleAxis({0, 0, RadFromDeg(3)}) * turned.rotation;
  scene.relative_poses[{0, 2}] = turned;
  RelativePose flipped = TrueRelativePose(scene, 2, 4);
  flipped.direction = -flipped.direction;
  scene.relative_poses[{2, 4}] = flipped;
  RelativePose off = TrueRelativePose(scene, 4, 6);
  off.direction = RotationFromAngleAxis(RadFromDeg(7) *
                                        TangentBasis(off.direction).col(0)) *
                  off.direction;
  scene.relative_poses[{4, 6}] = off;
  GroundTruth truth = GroundTruthFromScene(scene);
  truth.erase(8);
  scene.relative_poses[{6, 8}] = TrueRelativePose(scene, 6, 8);

  const auto result = EvaluateRelativePoses(scene, truth);
  EXPECT_EQ(result.num_without_truth, 1);
  ASSERT_EQ(result.pairs.size(), 3u);
  EXPECT_NEAR(result.pairs[0].rotation_error_deg, 3, 1e-9);
  EXPECT_NEAR(*result.pairs[0].direction_error_deg, 0, 1e-9);
  EXPECT_NEAR(*result.pairs[1].direction_error_deg, 180, 1e-5);
  EXPECT_NEAR(result.pairs[1].rotation_error_deg, 0, 1e-9);
  EXPECT_NEAR(*result.pairs[2].direction_error_deg, 7, 1e-9);
  EXPECT_NEAR(result.direction_deg.mean, 187.0 / 3, 1e-5);

  EXPECT_THAT(ToText(result), ::testing::HasSubstr("2-4"));
}

TEST(EvaluateRelativePoses, CoincidingCentresHaveNoDirection) {
  Scene scene = RandomScene(2, 3);
  scene.relative_poses[{0, 2}] = TrueRelativePose(scene, 0, 2);
  GroundTruth truth = GroundTruthFromScene(scene);
  truth.at(2).center = truth.at(0).center;
  const auto result = EvaluateRelativePoses(scene, truth);
  ASSERT_EQ(result.pairs.size(), 1u);
  EXPECT_FALSE(result.pairs[0].direction_error_deg.has_value());
  EXPECT_EQ(result.direction_deg.count, 0);
  EXPECT_EQ(result.rotation_deg.count, 1);
}

ScaleRatio MakeRatio(ViewTriplet views, RatioVerdict verdict,
                     double log_ratio) {
  ScaleRatio ratio;
  ratio.views = views;
  ratio.verdict = verdict;
  ratio.log_ratio = log_ratio;
  ratio.log_ratio_stddev = 0.25;
  return ratio;
}

TEST(EvaluateScaleRatios, ErrorsAreLogarithmicAndOnlyMeaningfulOnesCount) {
  Scene scene = RandomScene(4, 4);
  scene.poses.at(100).center = Vec3(0, 0, 0);
  scene.poses.at(102).center = Vec3(2, 0, 0);
  scene.poses.at(104).center = Vec3(2, 6, 0);
  scene.poses.at(106).center = Vec3(2, 6, 0);
  const double log3 = std::log(3.0);
  scene.scale_ratios = {
      MakeRatio({0, 2, 4}, RatioVerdict::kMeaningful, log3),
      MakeRatio({4, 2, 0}, RatioVerdict::kMeaningful, -log3 - 0.1),
      MakeRatio({0, 2, 6}, RatioVerdict::kNotMeaningful, 5),
      MakeRatio({2, 0, 4}, RatioVerdict::kNoCandidates, 0),
      MakeRatio({2, 4, 6}, RatioVerdict::kMeaningful, 0),   // no baseline
      MakeRatio({0, 2, 70}, RatioVerdict::kMeaningful, 0),  // no truth
  };
  const auto result = EvaluateScaleRatios(scene, GroundTruthFromScene(scene));
  ASSERT_EQ(result.ratios.size(), 3u);
  EXPECT_NEAR(result.ratios[0].true_log_ratio, log3, 1e-15);
  EXPECT_NEAR(result.ratios[0].log_error, 0, 1e-15);
  EXPECT_NEAR(result.ratios[1].log_error, -0.1, 1e-14);
  EXPECT_EQ(result.ratios[1].stddev, 0.25);
  EXPECT_EQ(result.ratios[2].verdict, RatioVerdict::kNotMeaningful);
  EXPECT_NEAR(result.ratios[2].log_error, 5 - log3, 1e-14);
  EXPECT_EQ(result.num_no_candidates, 1);
  EXPECT_EQ(result.num_without_truth, 2);
  EXPECT_EQ(result.abs_log_error.count, 2);
  EXPECT_NEAR(result.abs_log_error.max, 0.1, 1e-14);

  EXPECT_THAT(ToText(result), ::testing::HasSubstr("meaningful: 2"));
}

}  // namespace
}  // namespace lowlap
