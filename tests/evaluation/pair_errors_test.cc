#include "lowlap/evaluation/internal/pair_errors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "evaluation/random_poses.h"

namespace lowlap {
namespace {

void Turn(RelativePose* pose, double deg) {
  pose->rotation =
      RotationFromAngleAxis({0, 0, RadFromDeg(deg)}) * pose->rotation;
}

void Bend(RelativePose* pose, double deg) {
  pose->direction =
      RotationFromAngleAxis(RadFromDeg(deg) *
                            TangentBasis(pose->direction).col(0)) *
      pose->direction;
}

const PairError& Find(const PairEvaluation& evaluation, ViewPair views) {
  for (const PairError& pair : evaluation.pairs) {
    if (pair.views == views) return pair;
  }
  ADD_FAILURE() << "no pair " << views.first << "-" << views.second;
  return evaluation.pairs.front();
}

// Views 0, 2, ..., 8; the pairs 0-2, 2-4, 4-6 and 0-4.
Scene FiveViews() {
  Scene scene = RandomScene(5, 1);
  for (const ViewPair views :
       {ViewPair{0, 2}, ViewPair{2, 4}, ViewPair{4, 6}, ViewPair{0, 4}}) {
    RelativePose pose = TrueRelativePose(scene, views.first, views.second);
    pose.point_inliers.resize(7);
    pose.line_inliers.resize(3);
    pose.log10_nfa = -12;
    scene.relative_poses[views] = pose;
  }
  return scene;
}

TEST(EvaluatePairs, ConsecutivePairsCloseTheLoopAndMissingOnesFail) {
  const Scene scene = FiveViews();
  const auto result = EvaluatePairs(scene, GroundTruthFromScene(scene));
  ASSERT_TRUE(result);
  EXPECT_EQ(result->consecutive.num_pairs, 5);
  EXPECT_EQ(result->consecutive.num_without_pose, 2);  // 6-8 and 0-8
  EXPECT_EQ(result->consecutive.num_failed, 2);
  EXPECT_TRUE(Find(*result, {0, 8}).failed);
  EXPECT_TRUE(Find(*result, {0, 8}).consecutive);
  EXPECT_FALSE(Find(*result, {0, 4}).consecutive);
  EXPECT_EQ(result->all.num_pairs, 6);
  EXPECT_EQ(result->all.rotation_deg.count, 4);
  EXPECT_LT(result->all.rotation_deg.worst, 1e-9);
  EXPECT_EQ(Find(*result, {0, 2}).num_point_inliers, 7);
  EXPECT_EQ(Find(*result, {0, 2}).num_line_inliers, 3);
  EXPECT_EQ(Find(*result, {0, 2}).log10_nfa, -12);
}

TEST(EvaluatePairs, TruthsOfOtherViewsAreNoPairs) {
  const Scene scene = FiveViews();
  GroundTruth truth = GroundTruthFromScene(scene);
  truth[9] = truth.at(8);
  const auto result = EvaluatePairs(scene, truth);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->consecutive.num_pairs, 5);
  EXPECT_TRUE(Find(*result, {0, 8}).consecutive);
}

TEST(EvaluatePairs, FailsBeyondEitherLimit) {
  Scene scene = FiveViews();
  Turn(&scene.relative_poses.at({0, 2}), 2.1);
  Turn(&scene.relative_poses.at({2, 4}), 1.9);
  Bend(&scene.relative_poses.at({4, 6}), 8.1);
  Bend(&scene.relative_poses.at({0, 4}), 7.9);
  const auto result = EvaluatePairs(scene, GroundTruthFromScene(scene));
  ASSERT_TRUE(result);
  EXPECT_TRUE(Find(*result, {0, 2}).failed);
  EXPECT_FALSE(Find(*result, {2, 4}).failed);
  EXPECT_TRUE(Find(*result, {4, 6}).failed);
  EXPECT_FALSE(Find(*result, {0, 4}).failed);
  EXPECT_EQ(result->all.num_failed, 4);
  EXPECT_NEAR(result->all.rotation_deg.worst, 2.1, 1e-9);
  EXPECT_NEAR(result->consecutive.direction_deg.worst, 8.1, 1e-9);
}

TEST(EvaluatePairs, ExpectedPairsFailIfTheyAreMissing) {
  const Scene scene = FiveViews();
  PairEvaluationOptions options;
  options.expected = {{2, 8}, {0, 4}};
  GroundTruth truth = GroundTruthFromScene(scene);
  const auto result = EvaluatePairs(scene, truth, options);
  ASSERT_TRUE(result);
  EXPECT_TRUE(Find(*result, {2, 8}).failed);
  EXPECT_FALSE(Find(*result, {0, 4}).failed);
  EXPECT_EQ(result->all.num_pairs, 7);
  options.expected = {{2, 10}};
  EXPECT_EQ(EvaluatePairs(scene, truth, options).error().code,
            ErrorCode::kInvalidArgument);
  options.expected = {{4, 2}};
  EXPECT_EQ(EvaluatePairs(scene, truth, options).error().code,
            ErrorCode::kInvalidArgument);
}

TEST(EvaluatePairs, ViewsWithoutTruthAreNotJudged) {
  const Scene scene = FiveViews();
  GroundTruth truth = GroundTruthFromScene(scene);
  truth.erase(2);
  const auto result = EvaluatePairs(scene, truth);
  ASSERT_TRUE(result);
  EXPECT_EQ(result->num_without_truth, 2);
  // 0-4 is consecutive now.
  EXPECT_TRUE(Find(*result, {0, 4}).consecutive);
  EXPECT_EQ(result->consecutive.num_pairs, 4);
}

TEST(QuantilesOf, AreValuesThatOccur) {
  const ErrorQuantiles q = QuantilesOf({5, 1, 4, 2, 3, 6, 7, 8, 10, 9});
  EXPECT_EQ(q.count, 10);
  EXPECT_EQ(q.median, 5);
  EXPECT_EQ(q.p90, 9);
  EXPECT_EQ(q.worst, 10);
  EXPECT_EQ(QuantilesOf({3}).p90, 3);
  EXPECT_EQ(QuantilesOf({}).count, 0);
}

TEST(PairEvaluation, IsPrintedAndWritten) {
  const Scene scene = FiveViews();
  const auto result = EvaluatePairs(scene, GroundTruthFromScene(scene));
  ASSERT_TRUE(result);
  EXPECT_THAT(ToText(*result), ::testing::HasSubstr("no relative pose"));
  const auto json = nlohmann::json::parse(ToJson(*result));
  EXPECT_EQ(json["consecutive"]["num_failed"], 2);
  EXPECT_EQ(json["pairs"].size(), 6u);
  EXPECT_FALSE(json["pairs"][2].contains("rotation_error_deg"));
}

TEST(PairEvaluation, NoErrorsAreNoZeros) {
  Scene scene = FiveViews();
  scene.relative_poses.clear();
  const auto result = EvaluatePairs(scene, GroundTruthFromScene(scene));
  ASSERT_TRUE(result);
  EXPECT_THAT(ToText(*result),
              ::testing::HasSubstr("rotation  error (degrees): -\n"));
  EXPECT_THAT(ToText(*result), ::testing::Not(::testing::HasSubstr("0.000")));
}

}  // namespace
}  // namespace lowlap
