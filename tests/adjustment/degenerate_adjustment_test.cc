#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/scene/validation.h"
#include "test_scene.h"
#include "tests/support/matchers.h"

namespace lowlap {
namespace {

using test::ComparePoses;
using test::MakeTestScene;
using test::TestScene;
using test::TestSceneOptions;
using testing::IsError;
using testing::IsOk;

TEST(DegenerateAdjustmentTest, EmptySceneAndEmptyStructure) {
  Scene empty;
  EXPECT_THAT(AdjustScene(&empty, {}, {}),
              IsError(ErrorCode::kInsufficientData, "nothing to adjust"));
  TestScene test = MakeTestScene({});
  const Scene before = test.scene;
  EXPECT_THAT(AdjustScene(&test.scene, {}, {}),
              IsError(ErrorCode::kInsufficientData, "nothing to adjust"));
  EXPECT_TRUE(test.scene == before);
}

TEST(DegenerateAdjustmentTest, OneCameraHasNothingToAdjust) {
  TestScene test = MakeTestScene({});
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  const Pose pose = test.scene.poses.begin()->second;
  test.scene.poses = {{test.scene.poses.begin()->first, pose}};
  EXPECT_THAT(AdjustScene(&test.scene, {}, {}),
              IsError(ErrorCode::kInsufficientData, "nothing to adjust"));
}

TEST(DegenerateAdjustmentTest, LinesOfTwoViewsAloneConstrainNothing) {
  TestSceneOptions options;
  options.num_points = 0;
  options.max_line_views = 2;
  TestScene test = MakeTestScene(options);
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  ASSERT_FALSE(test.scene.line_structure.empty());
  EXPECT_THAT(AdjustScene(&test.scene, {}, {}),
              IsError(ErrorCode::kInsufficientData, "nothing to adjust"));
}

TEST(DegenerateAdjustmentTest, PointsBehindTheirCamerasAreRemoved) {
  TestScene test = MakeTestScene({});
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  // A landmark that came from elsewhere, without a track, behind all cameras.
  Landmark behind;
  behind.position = {3, 0, -20};
  for (const ViewId view : {ViewId{3}, ViewId{5}}) {
    behind.observations.push_back({view, kInvalidId, {600, 400}});
  }
  test.scene.structure[99999] = behind;
  const Result<AdjustmentSummary> summary = AdjustScene(&test.scene, {}, {});
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(test.scene.structure.count(99999), 0u);
  EXPECT_EQ(summary->landmarks_removed, 1u);
  EXPECT_LT(ComparePoses(test.true_poses, test.scene).max_center, 1e-6);
}

// Two rows of cameras that share nothing, in one scene.
TestScene TwoComponents() {
  TestSceneOptions options;
  options.num_views = 4;
  TestScene test = MakeTestScene(options);
  options.seed = 2;
  const TestScene other = MakeTestScene(options);
  constexpr std::uint32_t kShift = 5000;
  for (const auto& [id, view] : other.scene.views) {
    View shifted = view;
    shifted.pose_id = view.pose_id.value() + kShift;
    test.scene.views[id.value() + kShift] = shifted;
  }
  for (const auto& [id, features] : other.scene.features) {
    test.scene.features[id.value() + kShift] = features;
  }
  for (const auto& [id, pose] : other.scene.poses) {
    test.scene.poses[id.value() + kShift] = pose;
  }
  const auto shift_track = [](Track track) {
    for (FeatureRef& ref : track) ref.view = ref.view.value() + kShift;
    return track;
  };
  for (const auto& [id, track] : other.scene.point_tracks) {
    test.scene.point_tracks[id.value() + kShift] = shift_track(track);
  }
  for (const auto& [id, track] : other.scene.line_tracks) {
    test.scene.line_tracks[id.value() + kShift] = shift_track(track);
  }
  return test;
}

TEST(DegenerateAdjustmentTest, TwoComponentsAreSolvedEach) {
  TestScene test = TwoComponents();
  const std::map<PoseId, Pose> truth = test.scene.poses;
  test::PerturbPoses(0.005, 0.03, 5, &test.scene);
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  const Result<AdjustmentSummary> summary = AdjustScene(&test.scene, {}, {});
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(summary->components, 2u);
  EXPECT_EQ(summary->poses_adjusted, 8u);
  for (const bool second : {false, true}) {
    std::map<PoseId, Pose> part;
    for (const auto& [id, pose] : truth) {
      if ((id > 5000) == second) part[id] = pose;
    }
    EXPECT_LT(ComparePoses(part, test.scene).max_center, 1e-6);
  }
}

TEST(DegenerateAdjustmentTest, APoseWithoutObservationsKeepsItsValue) {
  TestSceneOptions options;
  options.noise_px = 0.3;
  TestScene test = MakeTestScene(options);
  View lonely = test.scene.views.begin()->second;
  lonely.pose_id = 777;
  test.scene.views[888] = lonely;
  test.scene.poses[777].center = {1, 2, 3};
  const Pose before = test.scene.poses.at(777);
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  const Result<AdjustmentSummary> summary = AdjustScene(&test.scene, {}, {});
  ASSERT_THAT(summary, IsOk());
  EXPECT_TRUE(test.scene.poses.at(777) == before);
  EXPECT_EQ(summary->poses_without_observations, std::vector<PoseId>{777});
  EXPECT_EQ(summary->poses_adjusted, 6u);
}

TEST(DegenerateAdjustmentTest, CoincidingCentresAreMovedApart) {
  TestScene test = MakeTestScene({});
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  for (auto& [id, pose] : test.scene.poses) {
    pose.center = test.scene.poses.begin()->second.center;
  }
  ASSERT_THAT(AdjustScene(&test.scene, {}, {}), IsOk());
  EXPECT_THAT(ValidateScene(test.scene), IsOk());
  for (const auto& [id, error] : test::CenterErrors(test)) {
    EXPECT_LT(error.norm(), 1e-3) << id.value();
  }
}

TEST(DegenerateAdjustmentTest, ObservationsInViewsWithoutPoseAreCounted) {
  TestScene test = MakeTestScene({});
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  std::size_t expected = 0;
  for (const auto& [id, landmark] : test.scene.structure) {
    for (const PointObservation& observation : landmark.observations) {
      expected += observation.view == 3 ? 1 : 0;
    }
  }
  for (const auto& [id, line] : test.scene.line_structure) {
    for (const FeatureRef& ref : line.observations) {
      expected += ref.view == 3 ? 1 : 0;
    }
  }
  test.scene.poses.erase(100);  // of view 3
  const Result<AdjustmentSummary> summary = AdjustScene(&test.scene, {}, {});
  ASSERT_THAT(summary, IsOk());
  EXPECT_EQ(summary->observations_without_camera, expected);
}

TEST(DegenerateAdjustmentTest, TwoViewsShareOnePose) {
  // A rig of two sensors at one place: no baseline between them, but both
  // observe.
  TestScene test = MakeTestScene({});
  View twin = test.scene.views.at(5);
  test.scene.views[500] = twin;
  test.scene.features[500] = test.scene.features.at(5);
  for (auto& [id, track] : test.scene.point_tracks) {
    for (std::size_t n = 0; n < track.size(); ++n) {
      if (track[n].view == 5) {
        track.push_back({500, track[n].feature});
        break;
      }
    }
  }
  test::PerturbPoses(0.005, 0.03, 5, &test.scene);
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  ASSERT_THAT(AdjustScene(&test.scene, {}, {}), IsOk());
  EXPECT_LT(ComparePoses(test.true_poses, test.scene).max_center, 1e-6);
}

// Whenever the host asks: the scene is then as it was.
TEST(DegenerateAdjustmentTest, StopsAtEveryStep) {
  TestSceneOptions scene_options;
  scene_options.noise_px = 0.5;
  TestScene test = MakeTestScene(scene_options);
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  test::PerturbPoses(0.01, 0.05, 3, &test.scene);
  const Scene before = test.scene;
  int calls = 0, last = std::numeric_limits<int>::max();
  RunContext context;
  context.progress = [&](const std::string&, std::size_t, std::size_t) {
    return ++calls < last;
  };
  Scene whole = before;
  ASSERT_THAT(AdjustScene(&whole, {}, context), IsOk());
  ASSERT_GT(calls, 10);
  const int all = calls;
  for (last = 1; last <= all; last += 7) {
    calls = 0;
    EXPECT_THAT(AdjustScene(&test.scene, {}, context),
                IsError(ErrorCode::kCancelled, ""));
    EXPECT_EQ(calls, last);
    EXPECT_TRUE(test.scene == before);
  }
}

TEST(DegenerateAdjustmentTest, BadInputLeavesTheSceneAlone) {
  EXPECT_THAT(AdjustScene(nullptr, {}, {}),
              IsError(ErrorCode::kInvalidArgument, "null"));
  TestScene test = MakeTestScene({});
  ASSERT_THAT(BuildStructure(&test.scene, {}, {}), IsOk());
  const Scene before = test.scene;

  AdjustmentOptions options;
  options.use_points = options.use_lines = false;
  EXPECT_THAT(AdjustScene(&test.scene, options, {}),
              IsError(ErrorCode::kInvalidArgument, "points or lines"));
  options = {};
  options.max_iterations = 0;
  EXPECT_THAT(AdjustScene(&test.scene, options, {}),
              IsError(ErrorCode::kInvalidArgument, "max_iterations"));
  options = {};
  options.min_threshold_px = 0;
  EXPECT_THAT(AdjustScene(&test.scene, options, {}),
              IsError(ErrorCode::kInvalidArgument, "min_threshold_px"));
  options = {};
  options.function_tolerance = std::nan("");
  EXPECT_THAT(AdjustScene(&test.scene, options, {}),
              IsError(ErrorCode::kInvalidArgument, "function_tolerance"));
  options = {};
  options.refine_intrinsics[12345] = {true, false, false};
  EXPECT_THAT(AdjustScene(&test.scene, options, {}),
              IsError(ErrorCode::kInvalidArgument, "12345"));
  RunContext cancel;
  cancel.progress = [](const std::string&, std::size_t, std::size_t) {
    return false;
  };
  EXPECT_THAT(AdjustScene(&test.scene, {}, cancel),
              IsError(ErrorCode::kCancelled, ""));
  EXPECT_TRUE(test.scene == before);

  for (int kind = 0; kind < 4; ++kind) {
    SCOPED_TRACE(kind);
    Scene bad = before;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    if (kind == 0) bad.structure.begin()->second.position.x() = nan;
    if (kind == 1) {
      bad.structure.begin()->second.observations[0].pixel_px.x() = nan;
    }
    if (kind == 2) bad.poses.begin()->second.rotation(0, 0) = nan;
    if (kind == 3) bad.intrinsics.begin()->second.fx_px = nan;
    EXPECT_THAT(AdjustScene(&bad, {}, {}),
                IsError(ErrorCode::kInvalidScene, ""));
  }
}

}  // namespace
}  // namespace lowlap
