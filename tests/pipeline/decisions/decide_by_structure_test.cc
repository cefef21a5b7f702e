#include "lowlap/pipeline/internal/decisions/decide_by_structure.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <string>
#include <utility>

#include "lowlap/evaluation/pose_errors.h"
#include "lowlap/pipeline/solve_scene.h"
#include "pipeline/ambiguous_wall.h"
#include "support/matchers.h"

namespace lowlap {
namespace {

using testing::IsError;
using testing::IsOk;
using testing::OtherMotion;
using testing::PutWrongMotionFirst;

using testing::Wall;

const ViewPair kPair = {2, 3};

/// The wall, of which no point is seen by more than two views, and an
/// adjustment of points alone: it cannot find back from a wrong motion by
/// itself. The lines, which more views see, tell.
SyntheticScene BlandWall(std::uint64_t seed) {
  SyntheticScene wall = Wall("chain", seed);
  for (auto& [id, track] : wall.scene.point_tracks) {
    const auto first = static_cast<std::ptrdiff_t>(
        id.value() % std::max<std::size_t>(1, track.size() - 1));
    track = Track(track.begin() + first, track.begin() + first + 2);
  }
  return wall;
}

SolveOptions PointsAlone() {
  SolveOptions options;
  options.adjustment.use_lines = false;
  options.adjustment.use_coplanar = false;
  return options;
}

/// A scene as far as its poses, with pairs that nothing has decided yet.
struct Composed {
  Scene scene;
  SceneRotations rotations;
  SolveResult result;
};

Composed Compose(Scene scene, const SolveOptions& options = PointsAlone()) {
  Composed composed;
  SolveStart start;
  for (const auto& [views, pose] : scene.relative_poses) {
    if (pose.alternatives.empty()) continue;
    start.motions.emplace_back();
    start.motions.back().views = views;
  }
  start.rotations =
      AverageSceneRotations(scene, options.poses, RunContext()).value();
  composed.result.ratios =
      EstimateBelievedRatios(&scene, start, options, RunContext(), nullptr)
          .value();
  composed.result.poses = ComposePoses(&scene, start.rotations, options.poses,
                                       RunContext(), nullptr)
                              .value();
  composed.result.motions = start.motions;
  composed.rotations = start.rotations;
  composed.scene = std::move(scene);
  return composed;
}

Status Decide(Composed* composed, const RunContext& context = {},
              const SolveOptions& options = PointsAlone()) {
  return DecideHypothesesByStructure(composed->rotations, options, context,
                                     nullptr, &composed->scene,
                                     &composed->result);
}

TEST(DecideHypothesesByStructure, TakesTheMotionThatExplainsTheScene) {
  for (std::uint64_t seed = 0; seed < 3; ++seed) {
    SyntheticScene wall = BlandWall(seed);
    const RelativePose right = wall.scene.relative_poses.at(kPair);
    PutWrongMotionFirst(kPair, &wall);
    Composed composed = Compose(wall.scene);
    ASSERT_THAT(Decide(&composed), IsOk());
    const HypothesisDecision& decision = composed.result.motions.front();
    EXPECT_EQ(decision.grounds, HypothesisGrounds::kStructure) << seed;
    EXPECT_TRUE(decision.replaced);
    EXPECT_GT(decision.margin, 46);
    EXPECT_TRUE(composed.scene.relative_poses.at(kPair) == right);
    EXPECT_LT(EvaluatePoses(composed.scene, wall.true_poses).position.max, 0.3)
        << seed;
  }
}

TEST(DecideHypothesesByStructure, ItDoesNotMatterWhichMotionComesFirst) {
  SyntheticScene wall = BlandWall(1), swapped = wall;
  PutWrongMotionFirst(kPair, &swapped);
  wall.scene.relative_poses.at(kPair).alternatives = {OtherMotion(kPair, wall)};
  Composed first = Compose(wall.scene), second = Compose(swapped.scene);
  ASSERT_THAT(Decide(&first), IsOk());
  ASSERT_THAT(Decide(&second), IsOk());
  EXPECT_EQ(first.result.motions.front().grounds,
            HypothesisGrounds::kStructure);
  EXPECT_FALSE(first.result.motions.front().replaced);
  EXPECT_TRUE(second.result.motions.front().replaced);
  EXPECT_TRUE(first.scene.relative_poses == second.scene.relative_poses);
  EXPECT_TRUE(first.scene.poses == second.scene.poses);
}

TEST(DecideHypothesesByStructure, SettlesSeveralPairs) {
  SyntheticScene wall = BlandWall(2);
  const auto right = wall.scene.relative_poses;
  PutWrongMotionFirst({1, 2}, &wall);
  PutWrongMotionFirst({3, 4}, &wall);
  Composed composed = Compose(wall.scene);
  ASSERT_THAT(Decide(&composed), IsOk());
  for (const HypothesisDecision& decision : composed.result.motions) {
    EXPECT_EQ(decision.grounds, HypothesisGrounds::kStructure);
    EXPECT_TRUE(decision.replaced);
  }
  EXPECT_TRUE(composed.scene.relative_poses == right);
}

// Two views are all that the tracks have: both motions explain them.
TEST(DecideHypothesesByStructure, LeavesWhatNothingTellsApart) {
  SyntheticScene wall = BlandWall(0);
  PutWrongMotionFirst({0, 1}, &wall);
  Scene& scene = wall.scene;
  for (const ViewId view : {2u, 3u, 4u, 5u}) {
    scene.views.erase(view);
    scene.features.erase(view);
  }
  const RelativePose pair = scene.relative_poses.at({0, 1});
  scene.relative_poses = {{ViewPair{0, 1}, pair}};
  auto& tracks = scene.point_tracks;
  for (auto entry = tracks.begin(); entry != tracks.end();) {
    const bool is_of_pair =
        entry->second.front().view == 0u && entry->second.back().view == 1u;
    entry = is_of_pair ? std::next(entry) : tracks.erase(entry);
  }
  scene.line_tracks.clear();
  Composed composed = Compose(scene);
  const Scene before = composed.scene;
  std::string logged;
  RunContext context;
  context.log = [&](LogLevel level, const std::string& text) {
    if (level == LogLevel::kWarning) logged += text;
  };
  ASSERT_THAT(Decide(&composed, context), IsOk());
  EXPECT_EQ(composed.result.motions.front().grounds, HypothesisGrounds::kNone);
  EXPECT_TRUE(composed.scene == before);
  EXPECT_NE(logged.find("nothing else tells them apart"), std::string::npos);
}

TEST(DecideHypothesesByStructure, AsksNothingWithoutAnAdjustment) {
  SyntheticScene wall = BlandWall(0);
  PutWrongMotionFirst(kPair, &wall);
  SolveOptions options = PointsAlone();
  options.adjust = false;
  Composed composed = Compose(wall.scene, options);
  const Scene before = composed.scene;
  ASSERT_THAT(Decide(&composed, {}, options), IsOk());
  EXPECT_EQ(composed.result.motions.front().grounds, HypothesisGrounds::kNone);
  EXPECT_TRUE(composed.scene == before);
}

TEST(DecideHypothesesByStructure, IsTheSameForAnyNumberOfThreads) {
  SyntheticScene wall = BlandWall(2);
  PutWrongMotionFirst({1, 2}, &wall);
  PutWrongMotionFirst({3, 4}, &wall);
  Composed one = Compose(wall.scene), two = one;
  RunContext context;
  context.num_threads = 1;
  ASSERT_THAT(Decide(&one, context), IsOk());
  context.num_threads = 2;
  ASSERT_THAT(Decide(&two, context), IsOk());
  EXPECT_TRUE(one.scene == two.scene);
  for (std::size_t n = 0; n < one.result.motions.size(); ++n) {
    EXPECT_EQ(one.result.motions[n].margin, two.result.motions[n].margin);
  }
}

TEST(DecideHypothesesByStructure, StopsOnRequest) {
  SyntheticScene wall = BlandWall(0);
  PutWrongMotionFirst(kPair, &wall);
  Composed composed = Compose(wall.scene);
  RunContext context;
  context.progress = [](const std::string&, std::size_t, std::size_t) {
    return false;
  };
  EXPECT_THAT(Decide(&composed, context), IsError(ErrorCode::kCancelled, ""));
}

}  // namespace
}  // namespace lowlap
