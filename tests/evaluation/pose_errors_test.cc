#include "lowlap/evaluation/pose_errors.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "evaluation/random_poses.h"

namespace lowlap {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

Similarity SomeSimilarity() {
  Similarity similarity;
  similarity.scale = 0.037;
  similarity.rotation = RotationFromAngleAxis({0.4, -2.0, 1.1});
  similarity.translation = Vec3(100, -20, 3);
  return similarity;
}

TEST(EvaluatePoses, ASimilarityOfTheTruthHasNoError) {
  for (const int num_views : {3, 4, 20}) {
    const Scene truth = RandomScene(num_views, 1);
    Scene solution = truth;
    Transform(SomeSimilarity(), solution);
    const PoseEvaluation result =
        EvaluatePoses(solution, GroundTruthFromScene(truth));
    EXPECT_EQ(result.scope, EvaluationScope::kFull);
    EXPECT_EQ(result.note, "");
    EXPECT_EQ(result.num_total, num_views);
    EXPECT_EQ(result.num_solved, num_views);
    EXPECT_EQ(result.views.size(), static_cast<std::size_t>(num_views));
    EXPECT_LT(result.position.max, 1e-11);
    EXPECT_LT(result.rotation_deg.max, 1e-11);
    EXPECT_LT(result.frame_disagreement_deg, 1e-10);
    EXPECT_NEAR(result.truth_from_solution.scale, 1 / 0.037, 1e-10);
  }
}

TEST(EvaluatePoses, ErrorsAreThoseThatWereMade) {
  const Scene truth = RandomScene(40, 2);
  Scene solution = truth;
  solution.poses.at(106).center += Vec3(0, 0.02, 0);
  solution.poses.at(110).rotation =
      RotationFromAngleAxis({RadFromDeg(0.5), 0, 0}) *
      solution.poses.at(110).rotation;
  Transform(SomeSimilarity(), solution);
  const PoseEvaluation result =
      EvaluatePoses(solution, GroundTruthFromScene(truth));
  // One of 40 cameras moves the alignment by a small part of its error.
  for (const ViewPoseError& error : result.views) {
    EXPECT_NEAR(error.position_error, error.view == 6 ? 0.02 : 0.0, 0.004);
    EXPECT_NEAR(error.rotation_error_deg, error.view == 10 ? 0.5 : 0.0, 0.02);
  }
  EXPECT_EQ(result.views[3].name, "image6.jpg");
  EXPECT_EQ(result.position.max, result.views[3].position_error);
  EXPECT_EQ(result.rotation_deg.max, result.views[5].rotation_error_deg);
  EXPECT_EQ(result.position.count, 40);
}

TEST(EvaluatePoses, AMirroredSolutionIsWrong) {
  const Scene truth = RandomScene(12, 3);
  Scene mirrored = truth;
  const Mat3 d = Vec3(1, 1, -1).asDiagonal();
  for (auto& [id, pose] : mirrored.poses) {
    pose.rotation = d * pose.rotation * d;
    pose.center = d * pose.center;
  }
  const PoseEvaluation result =
      EvaluatePoses(mirrored, GroundTruthFromScene(truth));
  EXPECT_GT(result.position.mean, 1.0);
  EXPECT_GT(result.rotation_deg.mean, 20.0);
}

TEST(EvaluatePoses, AWorldToCameraMixUpIsWrong) {
  const Scene truth = RandomScene(12, 4);
  Scene solution = truth;
  for (auto& [id, pose] : solution.poses) pose.rotation.transposeInPlace();
  const PoseEvaluation result =
      EvaluatePoses(solution, GroundTruthFromScene(truth));
  EXPECT_LT(result.position.max, 1e-11);
  EXPECT_GT(result.rotation_deg.mean, 20.0);
}

TEST(EvaluatePoses, CollinearCentresStillGiveRotations) {
  Scene truth = RandomScene(6, 5);
  double along = 0;
  for (auto& [id, pose] : truth.poses) {
    pose.center = Vec3(1, 2, 3) + (along += 0.7) * Vec3(0.6, 0, 0.8);
  }
  Scene solution = truth;
  Transform(SomeSimilarity(), solution);
  const PoseEvaluation result =
      EvaluatePoses(solution, GroundTruthFromScene(truth));
  EXPECT_EQ(result.scope, EvaluationScope::kFull);
  EXPECT_LT(result.position.max, 1e-10);
  EXPECT_LT(result.rotation_deg.max, 1e-10);
}

TEST(EvaluatePoses, TwoCamerasGiveRotationsOnly) {
  const Scene truth = RandomScene(2, 6);
  Scene solution = truth;
  Transform(SomeSimilarity(), solution);
  const PoseEvaluation exact =
      EvaluatePoses(solution, GroundTruthFromScene(truth));
  EXPECT_EQ(exact.scope, EvaluationScope::kRotationsOnly);
  EXPECT_THAT(exact.note, HasSubstr("2 cameras"));
  EXPECT_EQ(exact.position.count, 0);
  EXPECT_EQ(exact.rotation_deg.count, 2);
  EXPECT_LT(exact.rotation_deg.max, 1e-11);
  // A relative rotation that is wrong by 4 degrees is 2 for each camera.
  solution.poses.at(100).rotation =
      RotationFromAngleAxis({0, RadFromDeg(4), 0}) *
      solution.poses.at(100).rotation;
  const PoseEvaluation wrong =
      EvaluatePoses(solution, GroundTruthFromScene(truth));
  EXPECT_NEAR(wrong.views[0].rotation_error_deg, 2, 1e-9);
  EXPECT_NEAR(wrong.views[1].rotation_error_deg, 2, 1e-9);
}

TEST(EvaluatePoses, OneCameraAndNoneGiveNothing) {
  const Scene truth = RandomScene(3, 7);
  Scene solution = truth;
  solution.poses.erase(100);
  solution.poses.erase(104);
  PoseEvaluation result = EvaluatePoses(solution, GroundTruthFromScene(truth));
  EXPECT_EQ(result.scope, EvaluationScope::kNothing);
  EXPECT_EQ(result.num_solved, 1);
  EXPECT_EQ(result.num_total, 3);
  EXPECT_THAT(result.unsolved, ElementsAre("image0.jpg", "image4.jpg"));
  EXPECT_NE(result.note, "");
  EXPECT_FALSE(ToText(result).empty());
  solution.poses.clear();
  result = EvaluatePoses(solution, GroundTruthFromScene(truth));
  EXPECT_EQ(result.num_solved, 0);
  result = EvaluatePoses(Scene(), {});
  EXPECT_EQ(result.num_total, 0);
}

TEST(EvaluatePoses, NamesSolvedCamerasWithoutTruth) {
  const Scene solution = RandomScene(5, 8);
  GroundTruth truth = GroundTruthFromScene(solution);
  truth.erase(4);
  const PoseEvaluation result = EvaluatePoses(solution, truth);
  EXPECT_EQ(result.num_total, 4);
  EXPECT_THAT(result.without_truth, ElementsAre("image4.jpg"));
  EXPECT_THAT(ToText(result), HasSubstr("no truth"));
}

// Rotations are aligned apart from the centres: that all cameras look the wrong
// way shows in the turn between the two frames alone.
TEST(EvaluatePoses, CamerasThatLookTheWrongWayAreTold) {
  const Scene truth = RandomScene(12, 9);
  Scene solution = truth;
  const Mat3 turn = RotationFromAngleAxis({0, RadFromDeg(35), 0});
  for (auto& [id, pose] : solution.poses) pose.rotation *= turn.transpose();
  const PoseEvaluation result =
      EvaluatePoses(solution, GroundTruthFromScene(truth));
  EXPECT_LT(result.position.max, 1e-11);
  EXPECT_LT(result.rotation_deg.max, 1e-6);
  EXPECT_NEAR(result.frame_disagreement_deg, 35, 1e-6);
  EXPECT_THAT(ToText(result), HasSubstr("(degrees): 35"));
}

TEST(EvaluatePoses, SolvedCentresInOnePlaceGiveRotationsOnly) {
  const Scene truth = RandomScene(5, 8);
  Scene solution = truth;
  for (auto& [id, pose] : solution.poses) pose.center = Vec3(1, 2, 3);
  const PoseEvaluation result =
      EvaluatePoses(solution, GroundTruthFromScene(truth));
  EXPECT_EQ(result.scope, EvaluationScope::kRotationsOnly);
  EXPECT_THAT(result.note, HasSubstr("coincide"));
  EXPECT_LT(result.rotation_deg.max, 1e-11);
}

TEST(EvaluatePoses, OnlyViewsWithTruthCount) {
  const Scene truth = RandomScene(8, 9);
  GroundTruth partial = GroundTruthFromScene(truth);
  partial.erase(0);
  partial.emplace(77, Pose());  // a view that the scene does not have
  Scene solution = truth;
  solution.poses.at(100).center += Vec3(50, 0, 0);
  solution.poses.erase(102);
  const PoseEvaluation result = EvaluatePoses(solution, partial);
  EXPECT_EQ(result.num_total, 7);
  EXPECT_EQ(result.num_solved, 6);
  EXPECT_THAT(result.unsolved, ElementsAre("image2.jpg"));
  EXPECT_LT(result.position.max, 1e-11);
}

TEST(EvaluatePoses, FoldersTellImagesOfOneNameApart) {
  const Scene truth = RandomScene(4, 11);
  Scene solution = truth;
  for (auto& [id, view] : solution.views) {
    view.local_path = "cam" + std::to_string(id.value());
    view.filename = "0001.jpg";
  }
  solution.poses.erase(106);
  const PoseEvaluation result =
      EvaluatePoses(solution, GroundTruthFromScene(truth));
  EXPECT_EQ(result.views[1].name, "cam2/0001.jpg");
  EXPECT_THAT(result.unsolved, ElementsAre("cam6/0001.jpg"));
}

TEST(EvaluatePoses, TextAndJsonSayTheSame) {
  const Scene truth = RandomScene(4, 10);
  Scene solution = truth;
  solution.poses.at(100).center += Vec3(0.5, 0, 0);
  solution.poses.erase(106);
  const PoseEvaluation result =
      EvaluatePoses(solution, GroundTruthFromScene(truth));
  const auto json = nlohmann::json::parse(ToJson(result));
  EXPECT_EQ(json["scope"], "full");
  EXPECT_EQ(json["num_solved"], 3);
  EXPECT_EQ(json["num_total"], 4);
  EXPECT_EQ(json["unsolved"][0], "image6.jpg");
  EXPECT_EQ(json["position"]["mean"], result.position.mean);
  EXPECT_EQ(json["rotation_deg"]["count"], 3);
  EXPECT_EQ(json["views"][1]["view"], 2);
  EXPECT_EQ(json["views"][1]["position_error"], result.views[1].position_error);
  const std::string text = ToText(result);
  EXPECT_THAT(text, HasSubstr("cameras: 3 of 4"));
  EXPECT_THAT(text, HasSubstr("not solved"));
  EXPECT_THAT(text, HasSubstr("position error"));
  char mean[32];
  std::snprintf(mean, sizeof(mean), "mean %.6g", result.position.mean);
  EXPECT_THAT(text, HasSubstr(mean));

  // What was not evaluated is absent, not zero.
  solution.poses.erase(104);
  const PoseEvaluation two =
      EvaluatePoses(solution, GroundTruthFromScene(truth));
  const auto two_json = nlohmann::json::parse(ToJson(two));
  EXPECT_EQ(two_json["scope"], "rotations_only");
  EXPECT_FALSE(two_json.contains("position"));
  EXPECT_FALSE(two_json["views"][0].contains("position_error"));
  EXPECT_THAT(ToText(two), ::testing::Not(HasSubstr("position error")));
}

}  // namespace
}  // namespace lowlap
