#include "lowlap/pipeline/internal/judge_views.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>

#include "lowlap/averaging/reliability/internal/view_grades.h"
#include "lowlap/averaging/rigidity/internal/diagnosis.h"
#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/solve_scene.h"
#include "lowlap/synthetic/synthetic_scene.h"

namespace lowlap {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;

// Of hardly any points: relative poses are off by degrees, and state nothing
// that chance would not. But lines are seen in several views.
SyntheticScene RoomOfLines(std::uint64_t seed) {
  SyntheticOptions options;
  options.kind = SyntheticKind::kRoom;
  options.pairs = "loop:2";
  options.num_views = 8;
  options.points_per_wall = 6;
  options.lines_per_wall = 60;
  options.noise_px = 1;
  options.pose_noise_factor = 1;
  options.seed = seed;
  return *Simulate(options);
}

int CountFirm(const PoseSummary& summary) {
  int count = 0;
  for (const auto& entry : GradeViews(summary)) {
    count += entry.second.grade == ViewGrade::kFirm;
  }
  return count;
}

TEST(JudgeViews, TheStructureConfirmsWhatRelativePosesDoNotTell) {
  int num_firm = 0, num_firm_before = 0;
  for (std::uint64_t seed = 0; seed < 6; ++seed) {
    SyntheticScene room = RoomOfLines(seed);
    SyntheticScene before = room;
    StageLog stages;
    const auto result =
        SolveScene(&room.scene, SolveOptions(), RunContext(), &stages);
    ASSERT_TRUE(result) << result.error().ToString();
    SolveOptions without;
    without.adjust = false;
    const auto unadjusted =
        SolveScene(&before.scene, without, RunContext(), &stages);
    ASSERT_TRUE(unadjusted) << unadjusted.error().ToString();
    num_firm_before += CountFirm(unadjusted->poses);
    const int firm = CountFirm(result->poses);
    num_firm += firm;
    if (firm < 8) continue;
    EXPECT_LT(EvaluatePoses(room.scene, room.true_poses).position.max, 0.2);
    // Nothing that is listed as weak places a firm view.
    EXPECT_TRUE(result->poses.weak_ratios.empty());
  }
  // Of 48.
  EXPECT_GE(num_firm, 40);
  EXPECT_LE(num_firm_before, 24);
}

// The relative poses between the adjusted cameras serve for a while.
TEST(JudgeViews, LeavesTheMeasurementsAsTheyAre) {
  SyntheticScene room = RoomOfLines(1);
  SolveOptions options;
  options.reconsider_poses = false;
  StageLog stages;
  const Scene given = room.scene;
  const auto result = SolveScene(&room.scene, options, RunContext(), &stages);
  ASSERT_TRUE(result) << result.error().ToString();
  ASSERT_TRUE(std::any_of(
      room.scene.scale_ratios.begin(), room.scene.scale_ratios.end(),
      [](const ScaleRatio& ratio) { return IsWeak(ratio, {}); }));
  for (const auto& [views, pose] : room.scene.relative_poses) {
    const RelativePose& before = given.relative_poses.at(views);
    EXPECT_EQ(pose.rotation, before.rotation);
    EXPECT_EQ(pose.point_inliers, before.point_inliers);
  }
}

// Of a room that is firm, one camera is known to a tenth of the room only.
TEST(JudgeViews, WhatIsKnownTooLittleIsDoubtful) {
  SyntheticOptions room_options;
  room_options.num_views = 8;
  room_options.pairs = "window:3";
  SyntheticScene room = *Simulate(room_options);
  const SolveOptions options;
  StageLog stages;
  auto result = SolveScene(&room.scene, options, RunContext(), &stages);
  ASSERT_TRUE(result) << result.error().ToString();
  ASSERT_EQ(CountFirm(result->poses), 8);
  const double size = (room.scene.FindPose(ViewId(0))->center -
                       room.scene.FindPose(ViewId(4))->center)
                          .norm();
  room.scene.poses.at(room.scene.views.at(3).pose_id).center_covariance =
      Mat3::Identity() * (size / 10) * (size / 10);
  ASSERT_TRUE(JudgeViews(&room.scene, std::nullopt, *options.scale_estimator,
                         RunContext(), &result->poses));
  EXPECT_EQ(CountFirm(result->poses), 7);
  EXPECT_THAT(GradeViews(result->poses).at(3).reasons,
              ElementsAre("imprecise"));
}

// A room of which two halves have no point in common, and one relative pose
// joins them: the other pairs across were compared in vain.
SyntheticScene RoomOfTwoHalves() {
  constexpr std::uint32_t kHalf = 12;
  SyntheticOptions options;
  options.num_views = 2 * kHalf;
  options.pairs = "window:2";
  options.points_per_wall = 300;
  options.noise_px = 0.3;
  SyntheticScene room = *Simulate(options);
  for (std::uint32_t a = 0; a < kHalf; ++a) {
    for (std::uint32_t b = kHalf; b < 2 * kHalf; ++b) {
      if (b - a == 1) continue;
      room.scene.relative_poses.erase({a, b});
      room.scene.unrelated_pairs.push_back({a, b});
    }
  }
  std::map<PointTrackId, Track> halves;
  std::uint32_t next = 0;
  for (const auto& [id, track] : room.scene.point_tracks) {
    Track first, second;
    for (const FeatureRef& ref : track) {
      (ref.view < ViewId(kHalf) ? first : second).push_back(ref);
    }
    for (const Track& half : {first, second}) {
      if (half.size() > 1) halves[next++] = half;
    }
  }
  room.scene.point_tracks = std::move(halves);
  return room;
}

TEST(JudgeViews, MissingMatchesMakeViewsDoubtful) {
  const auto is_missing = ::testing::Field(&ReliabilityWarning::reason,
                                           WarningReason::kMissingMatches);
  SolveOptions options;
  options.adjust = false;
  SyntheticScene room = RoomOfTwoHalves();
  auto result = SolveScene(&room.scene, options, RunContext(), nullptr);
  ASSERT_TRUE(result) << result.error().ToString();
  EXPECT_EQ(result->poses.num_placed, 24);
  EXPECT_THAT(result->poses.reliability_warnings, Contains(is_missing));
  // Who was never asked is not missed.
  room = RoomOfTwoHalves();
  room.scene.unrelated_pairs.clear();
  result = SolveScene(&room.scene, options, RunContext(), nullptr);
  ASSERT_TRUE(result) << result.error().ToString();
  EXPECT_THAT(result->poses.reliability_warnings,
              ::testing::Not(Contains(is_missing)));
}

}  // namespace
}  // namespace lowlap
