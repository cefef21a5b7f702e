#include "lowlap/adjustment/internal/rounds/optimum_search.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <iterator>
#include <string>

#include "lowlap/adjustment/bundle_adjuster.h"
#include "lowlap/geometry/internal/rotation.h"
#include "test_scene.h"

namespace lowlap {
namespace {

using test::ComparePoses;
using test::MakeTestScene;
using test::TestScene;
using test::TestSceneOptions;

// Only lines of three views carry the scale from pair to pair.
TestScene ChainOfLines(std::uint64_t seed) {
  TestSceneOptions options;
  options.num_views = 7;
  options.num_points = 600;
  options.max_point_views = 2;
  options.num_lines = 200;
  options.max_line_views = 3;
  options.noise_px = 0.1;
  options.seed = seed;
  return MakeTestScene(options);
}

// What comes after the middle view is too large.
void StretchSecondHalf(double factor, Scene* scene) {
  const std::size_t middle = scene->poses.size() / 2;
  const Vec3 pivot = std::next(scene->poses.begin(), middle)->second.center;
  for (auto it = std::next(scene->poses.begin(), middle);
       it != scene->poses.end(); ++it) {
    it->second.center = pivot + factor * (it->second.center - pivot);
  }
}

AdjustmentOptions Options() {
  AdjustmentOptions options;
  options.coplanar_ties = CoplanarTies::kPairs;
  return options;
}

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

bool SearchedFrom(const std::string& name, const AdjustmentSummary& summary) {
  return std::any_of(summary.solves.begin(), summary.solves.end(),
                     [&](const SolveReport& report) {
                       return report.stage.rfind(name + ": ", 0) == 0;
                     });
}

bool SearchedAgain(const AdjustmentSummary& summary) {
  return SearchedFrom("again", summary);
}

// All lines over the joint are out of use, and hold nothing.
TEST(OptimumSearchTest, BringsBackWhatDriftPutOutOfUse) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    TestScene test = ChainOfLines(seed);
    StretchSecondHalf(1.2, &test.scene);
    const AdjustmentSummary summary =
        test::BuildAndAdjust(&test.scene, Options());
    EXPECT_TRUE(SearchedAgain(summary));
    EXPECT_EQ(summary.solves.back().stage, "final");
    EXPECT_LT(ComparePoses(test.true_poses, test.scene).mean_center, 0.003)
        << "seed " << seed;
  }
}

TEST(OptimumSearchTest, LinesBringBackWhatPointsLeadAstray) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    TestScene test = ChainOfLines(seed);
    TurnPointsAndCameras(test, 0.03, &test.scene);
    const AdjustmentSummary summary =
        test::BuildAndAdjust(&test.scene, Options());
    EXPECT_TRUE(SearchedFrom("lines first", summary));
    EXPECT_TRUE(SearchedFrom("points first", summary));
    EXPECT_LT(ComparePoses(test.true_poses, test.scene).mean_center, 0.003)
        << "seed " << seed;
  }
}

TEST(OptimumSearchTest, LeavesGoodScenesAsGood) {
  for (const std::uint64_t seed : {1, 2, 3}) {
    TestScene test = ChainOfLines(seed);
    test::BuildAndAdjust(&test.scene, Options());
    EXPECT_LT(ComparePoses(test.true_poses, test.scene).mean_center, 0.003)
        << "seed " << seed;
  }
}

// Points that many views see need no other start.
TEST(OptimumSearchTest, StartsOnceWhereMostIsSeenByMoreThanTwo) {
  TestScene test = MakeTestScene({});
  const AdjustmentSummary summary =
      test::BuildAndAdjust(&test.scene, Options());
  EXPECT_FALSE(SearchedFrom("lines first", summary));
  EXPECT_FALSE(SearchedFrom("points first", summary));
}

TEST(OptimumSearchTest, WithoutRoundsTheObservationsStay) {
  TestScene test = ChainOfLines(1);
  AdjustmentOptions options = Options();
  options.max_outlier_rounds = 0;
  EXPECT_FALSE(SearchedAgain(test::BuildAndAdjust(&test.scene, options)));
}

}  // namespace
}  // namespace lowlap
