#include "lowlap/two_view/internal/lone_matches.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>

#include "tests/two_view/two_view_scene.h"

namespace lowlap {
namespace {

using testing::AllIndices;
using ::testing::Contains;
using testing::DirectionErrorDeg;
using ::testing::Each;
using testing::kFocalPx;
using ::testing::Le;
using testing::MakeTwoViewScene;
using ::testing::Not;
using testing::TwoViewScene;
using testing::TwoViewSceneOptions;

const PoseRefinementOptions kLoss = {0.5, 50, {}, 0};

TEST(Leverages, SumUpToTheUnknowns) {
  TwoViewSceneOptions options;
  options.noise_px = 0.3;
  const TwoViewScene scene = MakeTwoViewScene(options, 1);
  const PointPairs pairs = scene.Pairs();
  const RigidTransform pose =
      RefineRelativePose(scene.cam2_from_cam1, pairs, AllIndices(pairs), kLoss);
  const auto leverages = Leverages(pose, pairs, AllIndices(pairs), kLoss);
  ASSERT_EQ(leverages.size(), static_cast<std::size_t>(pairs.size()));
  EXPECT_NEAR(std::accumulate(leverages.begin(), leverages.end(), 0.0), 5,
              1e-6);
  EXPECT_THAT(leverages, Each(Le(1)));
}

TEST(Leverages, NoneWhereTheMatchesDoNotDetermineThePose) {
  const TwoViewScene scene = MakeTwoViewScene({}, 2);
  EXPECT_TRUE(
      Leverages(scene.cam2_from_cam1, scene.Pairs(), {0, 1, 2}, kLoss).empty());
}

TEST(LoneMatches, AreNoneAmongManyPoints) {
  TwoViewSceneOptions options;
  options.noise_px = 0.3;
  const TwoViewScene scene = MakeTwoViewScene(options, 3);
  const PointPairs pairs = scene.Pairs();
  const RigidTransform pose =
      RefineRelativePose(scene.cam2_from_cam1, pairs, AllIndices(pairs), kLoss);
  EXPECT_EQ(BorneOutMatches(pose, pairs, AllIndices(pairs), kLoss),
            AllIndices(pairs));
}

// All points but one are far: they say little of the direction, and the pose
// goes through the near one, though it is 40 pixels off.
TEST(LoneMatches, AWrongOneThatHoldsThePoseIsLeftOut) {
  double with = 0, without = 0;
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6}) {
    TwoViewSceneOptions options;
    options.num_right = 150;
    options.noise_px = 0.05;
    options.baseline = 0.01;
    const TwoViewScene scene = MakeTwoViewScene(options, seed);
    const Vec3& truth = scene.cam2_from_cam1.translation;
    PointPairs pairs = scene.Pairs();
    const int wrong = pairs.size();
    const Vec3 ray1 = Vec3(0.05, 0.1, 1);
    const Vec3 ray2 = scene.cam2_from_cam1.rotation * (0.05 * ray1) +
                      options.baseline * truth;
    pairs.x1.push_back(ray1);
    pairs.x2.push_back(ray2 / ray2.z() + Vec3(0, 40 / kFocalPx, 0));
    const RigidTransform pose = RefineRelativePose(scene.cam2_from_cam1, pairs,
                                                   AllIndices(pairs), kLoss);
    ASSERT_LT(std::abs(SampsonResidual(pose, pairs)(wrong)), 1) << seed;
    const auto borne_out =
        BorneOutMatches(pose, pairs, AllIndices(pairs), kLoss);
    EXPECT_THAT(borne_out, Not(Contains(wrong))) << seed;
    const RigidTransform rest =
        RefineRelativePose(pose, pairs, borne_out, kLoss);
    with += DirectionErrorDeg(pose.translation, truth);
    without += DirectionErrorDeg(rest.translation, truth);
  }
  EXPECT_LT(without, 0.5 * with);
}

// What is left of few matches has larger leverages, again and again: they would
// fall to six that hold nothing.
TEST(LoneMatches, LeavingThemOutDoesNotRunAway) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5, 6, 7, 8}) {
    TwoViewSceneOptions options;
    options.num_right = 18;
    options.noise_px = 0.5;
    const TwoViewScene scene = MakeTwoViewScene(options, seed);
    const PointPairs pairs = scene.Pairs();
    const RigidTransform pose = RefineRelativePose(scene.cam2_from_cam1, pairs,
                                                   AllIndices(pairs), kLoss);
    const auto borne_out =
        BorneOutMatches(pose, pairs, AllIndices(pairs), kLoss);
    EXPECT_GE(borne_out.size(), 12u) << seed;
  }
}

TEST(LoneMatches, FewMatchesStay) {
  const TwoViewScene scene = MakeTwoViewScene({}, 4);
  const std::vector<int> six = {0, 1, 2, 3, 4, 5};
  EXPECT_EQ(BorneOutMatches(scene.cam2_from_cam1, scene.Pairs(), six, kLoss),
            six);
}

}  // namespace
}  // namespace lowlap
