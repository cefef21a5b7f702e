#include "lowlap/adjustment/internal/rounds/optimum_starts.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <cstdint>
#include <iterator>
#include <string>
#include <thread>
#include <vector>

#include "line_chain.h"
#include "lowlap/geometry/internal/rotation.h"

namespace lowlap {
namespace {

using test::BuildAndAdjust;
using test::ChainOfLines;
using test::ComparePoses;
using test::SearchedFrom;
using test::TestScene;
using test::WithPairs;

// Turns what comes after a joint of the chain about the camera before it, and
// the points that both cameras of the joint see with it: all bear the wrong
// relative pose out.
void TurnPointsAndCameras(const TestScene& test, double angle_rad,
                          Scene* scene) {
  const std::size_t middle = scene->poses.size() / 2;
  const auto before = std::next(scene->views.begin(), middle - 1);
  const auto after = std::next(before);
  const Vec3 pivot = scene->FindPose(before->first)->center;
  const Mat3 turn = RotationFromAngleAxis(angle_rad * Vec3(0.3, 0.8, 0.5));
  for (auto it = after; it != scene->views.end(); ++it) {
    Pose& pose = scene->poses.at(it->second.pose_id);
    pose.rotation = pose.rotation * turn.transpose();
    pose.center = pivot + turn * (pose.center - pivot);
  }
  const RigidTransform camera = scene->FindPose(after->first)->CamFromWorld();
  for (const auto& [id, track] : scene->point_tracks) {
    if (track.front().view != before->first ||
        track.back().view != after->first) {
      continue;
    }
    scene->features.at(after->first).points_px[track.back().feature] =
        scene->FindIntrinsic(after->first)
            ->Project(camera * test.true_points.at(id));
  }
}

TEST(OptimumStartsTest, LinesBringBackWhatPointsLeadAstray) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    TestScene test = ChainOfLines(seed);
    TurnPointsAndCameras(test, 0.03, &test.scene);
    const AdjustmentSummary summary = BuildAndAdjust(&test.scene, WithPairs());
    EXPECT_TRUE(SearchedFrom("lines first", summary));
    EXPECT_TRUE(SearchedFrom("points first", summary));
    EXPECT_LT(ComparePoses(test.true_poses, test.scene).mean_center, 0.003)
        << "seed " << seed;
  }
}

// Points that many views see need no other start.
TEST(OptimumStartsTest, StartsOnceWhereMostIsSeenByMoreThanTwo) {
  TestScene test = test::MakeTestScene({});
  const AdjustmentSummary summary = BuildAndAdjust(&test.scene, WithPairs());
  EXPECT_FALSE(SearchedFrom("lines first", summary));
  EXPECT_FALSE(SearchedFrom("points first", summary));
}

TEST(OptimumStartsTest, OneKindAloneHasOneStart) {
  TestScene test = ChainOfLines(1);
  AdjustmentOptions options = WithPairs();
  options.use_points = false;
  const AdjustmentSummary summary = BuildAndAdjust(&test.scene, options);
  EXPECT_FALSE(SearchedFrom("lines first", summary));
  EXPECT_FALSE(SearchedFrom("points first", summary));
}

TEST(OptimumStartsTest, ThreadsChangeNothing) {
  TestScene test = ChainOfLines(2);
  TurnPointsAndCameras(test, 0.03, &test.scene);
  ASSERT_TRUE(BuildStructure(&test.scene, {}, {}));
  std::vector<Scene> scenes;
  std::vector<std::vector<std::string>> messages;
  for (const int threads : {1, 2, 4}) {
    RunContext context;
    context.num_threads = threads;
    std::vector<std::string> said;
    context.log = [&](LogLevel, const std::string& message) {
      said.push_back(message);
    };
    std::atomic<int> inside{0};
    context.progress = [&](const std::string&, std::size_t, std::size_t) {
      EXPECT_EQ(inside.fetch_add(1), 0) << "two threads report at a time";
      std::this_thread::sleep_for(std::chrono::microseconds(200));
      inside.fetch_sub(1);
      return true;
    };
    scenes.push_back(test.scene);
    const auto summary = AdjustScene(&scenes.back(), WithPairs(), context);
    ASSERT_TRUE(summary);
    EXPECT_TRUE(SearchedFrom("lines first", *summary));
    messages.push_back(said);
  }
  EXPECT_EQ(scenes[1].poses, scenes[0].poses);
  EXPECT_EQ(scenes[2].poses, scenes[0].poses);
  EXPECT_EQ(messages[1], messages[0]);
  EXPECT_EQ(messages[2], messages[0]);
}

TEST(OptimumStartsTest, StopsInAnyOfTheStarts) {
  for (const std::string start : {"lines first", "points first"}) {
    TestScene test = ChainOfLines(2);
    ASSERT_TRUE(BuildStructure(&test.scene, {}, {}));
    RunContext context;
    context.num_threads = 2;
    context.progress = [&](const std::string& stage, std::size_t, std::size_t) {
      return stage.find(start) == std::string::npos;
    };
    const auto summary = AdjustScene(&test.scene, WithPairs(), context);
    ASSERT_FALSE(summary) << start;
    EXPECT_EQ(summary.error().code, ErrorCode::kCancelled) << start;
  }
}

}  // namespace
}  // namespace lowlap
