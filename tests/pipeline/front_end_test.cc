#include <gtest/gtest.h>

#include "lowlap/pipeline/internal/measure/relative_poses.h"
#include "lowlap/pipeline/internal/scene_reduction.h"
#include "lowlap/scene/validation.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

TEST(KeepMatchedFeatures, DropsUnusedFeaturesAndKeepsEveryReference) {
  SyntheticOptions options;
  options.num_views = 5;
  Scene scene = Simulate(options)->scene;
  // The same scene with useless features in front of and behind the others.
  Scene padded = scene;
  scene.features.at(2).repeated_points = {3, 5};
  padded.features.at(2).repeated_points = {0, 4, 6};
  scene.features.at(3).repeated_segments = {4};
  padded.features.at(3).repeated_segments = {0, 5};
  for (auto& [view, features] : padded.features) {
    features.points_px.insert(features.points_px.begin(), Vec2(1, 1));
    features.points_px.push_back(Vec2(2, 2));
    features.segments.insert(features.segments.begin(), LineSegment());
  }
  for (auto& [views, pose] : padded.relative_poses) {
    for (auto* matches : {&pose.point_inliers, &pose.line_inliers}) {
      for (FeatureMatch& match : *matches) ++match.first, ++match.second;
    }
  }
  const auto shift = [](auto* tracks) {
    for (auto& [id, track] : *tracks) {
      for (FeatureRef& ref : track) ++ref.feature;
    }
  };
  shift(&padded.point_tracks);
  shift(&padded.line_tracks);
  KeepMatchedFeatures(&scene);
  KeepMatchedFeatures(&padded);
  EXPECT_TRUE(padded == scene);
  EXPECT_TRUE(ValidateScene(padded));
}

TEST(LimitPointMatches, KeepsTheLongestTracksAndAValidScene) {
  SyntheticOptions options;
  options.num_views = 6;
  options.pairs = "window:2";
  Scene scene = Simulate(options)->scene;
  const Scene full = scene;
  ASSERT_TRUE(LimitPointMatches(20, &scene));
  EXPECT_TRUE(ValidateScene(scene));
  for (const auto& [views, pose] : scene.relative_poses) {
    EXPECT_LE(pose.point_inliers.size(), 20u);
    EXPECT_EQ(pose.line_inliers.size(),
              full.relative_poses.at(views).line_inliers.size());
  }
  std::size_t three_views = 0;
  for (const auto& [id, track] : scene.point_tracks) {
    three_views += track.size() >= 3 ? 1 : 0;
  }
  EXPECT_GT(2 * three_views, scene.point_tracks.size());
  EXPECT_LT(scene.features.at(2).points_px.size(),
            full.features.at(2).points_px.size());
  EXPECT_FALSE(LimitPointMatches(0, &scene));
}

TEST(EstimateRelativePoses, PairsThatFailAreReportedWithAReason) {
  SyntheticOptions options;
  options.num_views = 4;
  options.pairs = "chain";
  SyntheticScene synthetic = *Simulate(options);
  std::map<ViewPair, PairMatches> matches;
  for (const auto& [views, pose] : synthetic.scene.relative_poses) {
    matches[views] = {pose.point_inliers, pose.line_inliers};
  }
  matches.begin()->second.points.resize(3);
  matches.begin()->second.lines.resize(3);
  const auto reports = EstimateRelativePoses(
      &synthetic.scene, matches, nullptr, RelativePoseOptions(), RunContext());
  ASSERT_TRUE(reports);
  ASSERT_EQ(reports->size(), 3u);
  EXPECT_FALSE((*reports)[0].accepted);
  EXPECT_FALSE((*reports)[0].reason.empty());
  EXPECT_TRUE((*reports)[1].accepted) << (*reports)[1].reason;
  EXPECT_EQ(synthetic.scene.relative_poses.size(), 2u);
}

TEST(EstimateRelativePoses, ThreadsDoNotChangeTheResult) {
  SyntheticOptions options;
  options.num_views = 6;
  options.pairs = "window:2";
  options.noise_px = 0.7;
  options.wrong_point_share = 0.3;
  const SyntheticScene synthetic = *Simulate(options);
  std::map<ViewPair, PairMatches> matches;
  for (const auto& [views, pose] : synthetic.scene.relative_poses) {
    matches[views] = {pose.point_inliers, pose.line_inliers};
  }
  Scene one = synthetic.scene, two = synthetic.scene;
  RunContext context;
  context.num_threads = 1;
  ASSERT_TRUE(EstimateRelativePoses(&one, matches, nullptr,
                                    RelativePoseOptions(), context));
  context.num_threads = 2;
  ASSERT_TRUE(EstimateRelativePoses(&two, matches, nullptr,
                                    RelativePoseOptions(), context));
  EXPECT_TRUE(one == two);
}

}  // namespace
}  // namespace lowlap
